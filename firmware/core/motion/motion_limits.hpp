// How fast a reference may change, in the integer units that references are made of.
#pragma once

#include <cstdint>

#include "firmware/core/arithmetic/count_position.hpp"

namespace firmware {

/// Velocity, acceleration and jerk limits as increments per sample, per sample^2, per sample^3.
struct MotionLimits {
  Increment velocity = 0;
  Increment acceleration = 0;
  Increment jerk = 0;
};

enum class MotionLimitError : std::uint8_t {
  none,
  velocity_out_of_range,      ///< above 2^14 counts a sample, or too small to be represented
  acceleration_out_of_range,  ///< above 2^14 counts a sample^2, or too small to be represented
  jerk_out_of_range,          ///< above 2^14 counts a sample^3, or too small to be represented
  jerk_time_out_of_range,     ///< acceleration / jerk is so long that one ramp would pass 2^14 counts a sample
};

inline constexpr Increment kMostMotion = Increment{1} << (kFractionBits + 14);
/// Plans take up to four units off a limit, and a conversion cuts one: a limit of so many units is kept to 1 %.
inline constexpr Increment kLeastMotion = 512;

constexpr MotionLimitError check(const MotionLimits& limits) {
  const auto in_range = [](Increment value) { return value >= kLeastMotion && value <= kMostMotion; };
  if (!in_range(limits.velocity)) return MotionLimitError::velocity_out_of_range;
  if (!in_range(limits.acceleration)) return MotionLimitError::acceleration_out_of_range;
  if (!in_range(limits.jerk)) return MotionLimitError::jerk_out_of_range;
  // A ramp to full acceleration and back adds acceleration * steps to the velocity, where steps rounds up.
  const Increment steps = limits.acceleration / limits.jerk + 2;
  if (steps > kMostMotion / limits.acceleration) return MotionLimitError::jerk_time_out_of_range;
  return MotionLimitError::none;
}

}  // namespace firmware
