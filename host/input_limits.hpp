// Size limits of inputs, which may be damaged, accidentally or on purpose. Larger input is refused before it costs
// memory or time, and the message names the limit. host/README.md lists the limits.
#pragma once

#include <cstddef>
#include <string_view>

namespace host {

struct ByteLimit {
  std::string_view of;  ///< the limited input, for messages
  std::size_t bytes;
  bool in_lines;  ///< text: a line longer than kLongestLine ends the reading at once (/dev/zero never ends)
};

inline constexpr std::size_t kMebibyte = std::size_t{1} << 20U;
inline constexpr std::size_t kLongestLine = kMebibyte;

/// Models, scenarios, parameters, results of other commands, images.
inline constexpr ByteLimit kDocumentSize{"a document", 16 * kMebibyte, false};
inline constexpr ByteLimit kProgramSize{"a G-code program", 64 * kMebibyte, true};
inline constexpr ByteLimit kRecordSize{"a record", 1024 * kMebibyte, true};
inline constexpr ByteLimit kLogSize{"a log", 1024 * kMebibyte, false};

/// Numbers in an unpacked record or log: 400 MB in memory, or an hour of five channels at 2.7 kHz.
inline constexpr std::size_t kMostLogNumbers = 50'000'000;

/// Limits of a model. The largest model of the search has a tenth of each.
inline constexpr std::size_t kMostEffects = 64, kMostHarmonics = 128, kMostKnots = 1000;

/// Limits of a G-code program. A move takes some 350 bytes and 0.1 ms of planning, a node 100 bytes.
inline constexpr std::size_t kMostPathMoves = 200'000, kMostPathNodes = 2'000'000;
inline constexpr double kLongestPath_s = 36'000.0;

}  // namespace host
