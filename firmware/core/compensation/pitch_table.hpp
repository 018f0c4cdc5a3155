// What was measured of a screw: by how much the table is beyond where the encoder says, at places along the travel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace firmware {

inline constexpr std::size_t kMostPitchPoints = 256;

/// Deviations as ISO 230-2 has them: actual minus commanded position of the table, for approach in the positive and in
/// the negative direction. In 2^-16 counts; as they lie in flash.
struct PitchPoint {
  std::int32_t counts = 0;  ///< from home
  std::int32_t forward = 0, backward = 0;
  bool operator==(const PitchPoint&) const = default;
};
static_assert(sizeof(PitchPoint) == 12);

/// In rising order; before the first and behind the last the deviation stays what it is there. Empty: none.
using PitchTable = std::span<const PitchPoint>;

inline constexpr std::int32_t kLargestDeviation = 1 << 29;  ///< 2^13 counts
/// 2^-16 counts a count: a quarter of what an interpolated reference may be faster than its limit
/// (supervision/increment_limits.hpp).
inline constexpr std::int64_t kSteepestDeviation = 65536 / 64;

constexpr bool is_valid(const PitchPoint& point) {
  const auto is_small = [](std::int32_t value) { return value <= kLargestDeviation && value >= -kLargestDeviation; };
  return is_small(point.forward) && is_small(point.backward);
}

/// Both valid.
constexpr bool may_follow(const PitchPoint& last, const PitchPoint& next) {
  const std::int64_t way = std::int64_t{next.counts} - last.counts;
  const auto is_gentle = [way](std::int64_t change) {
    return change <= way * kSteepestDeviation && change >= -way * kSteepestDeviation;
  };
  return way > 0 && is_gentle(std::int64_t{next.forward} - last.forward) &&
         is_gentle(std::int64_t{next.backward} - last.backward);
}

}  // namespace firmware
