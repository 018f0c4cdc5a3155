// Measured errors of a screw: deviation of the table from the encoder's position, at points along the travel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace firmware {

inline constexpr std::size_t kMostPitchPoints = 256;

/// Deviations as in ISO 230-2: actual minus commanded position of the table, for approach in the positive and in the
/// negative direction. In 2^-16 counts; stored in flash in this form.
struct PitchPoint {
  std::int32_t counts = 0;  ///< from home
  std::int32_t forward = 0, backward = 0;
  bool operator==(const PitchPoint&) const = default;
};
static_assert(sizeof(PitchPoint) == 12);

/// In ascending order; the deviation is constant before the first and after the last point. Empty: no table.
using PitchTable = std::span<const PitchPoint>;

inline constexpr std::int32_t kLargestDeviation = 1 << 29;  ///< 2^13 counts
/// 2^-16 counts per count: a quarter of the margin of an interpolated reference above its velocity limit
/// (supervision/increment_limits.hpp).
inline constexpr std::int64_t kSteepestDeviation = 65536 / 64;

constexpr bool is_valid(const PitchPoint& point) {
  const auto is_small = [](std::int32_t value) { return value <= kLargestDeviation && value >= -kLargestDeviation; };
  return is_small(point.forward) && is_small(point.backward);
}

/// Both points are valid.
constexpr bool may_follow(const PitchPoint& last, const PitchPoint& next) {
  const std::int64_t way = std::int64_t{next.counts} - last.counts;
  const auto is_gentle = [way](std::int64_t change) {
    return change <= way * kSteepestDeviation && change >= -way * kSteepestDeviation;
  };
  return way > 0 && is_gentle(std::int64_t{next.forward} - last.forward) &&
         is_gentle(std::int64_t{next.backward} - last.backward);
}

}  // namespace firmware
