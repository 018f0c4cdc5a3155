// Payloads of the requests for a table of pitch errors. Little-endian, in the layout of the report: README.md.
#pragma once

#include "firmware/app/protocol/messages.hpp"
#include "firmware/core/compensation/pitch_table.hpp"

namespace firmware {

struct BeginTableRequest {
  std::uint8_t axis = 0;
  std::uint8_t reserved = 0;
  std::uint16_t points = 0;           ///< number of points, 2..kMostPitchPoints; 0 removes the axis's table
  std::uint32_t resolution_bits = 0;  ///< drive.encoder_resolution, in whose counts they are
};

inline constexpr std::size_t kPointsPerReport = 4;

struct TablePointsRequest {
  std::uint16_t first = 0;  ///< number of points sent before
  std::uint8_t count = 0;
  std::uint8_t reserved = 0;
  std::array<PitchPoint, kPointsPerReport> point{};
};
static_assert(sizeof(TablePointsRequest) == kPayloadSize);

struct FinishTableRequest {
  std::uint32_t crc = 0;  ///< CRC-32 of all points, in the layout of the reports
  std::uint8_t on = 0;    ///< the axis's pitch.on from now on
  std::array<std::uint8_t, 3> reserved{};
};

struct ReadTableRequest {
  std::uint8_t axis = 0;
  std::uint8_t reserved = 0;
  std::uint16_t first = 0;
};

/// The points from `first` on, up to kPointsPerReport.
struct TablePointsPayload {
  std::uint16_t points = 0;  ///< that there are
  std::uint16_t first = 0;
  std::array<PitchPoint, kPointsPerReport> point{};
};
static_assert(sizeof(TablePointsPayload) == kPayloadSize);

}  // namespace firmware
