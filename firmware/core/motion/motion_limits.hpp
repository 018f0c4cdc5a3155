// How fast a reference may change, in the integer units of references.
#pragma once

#include <cstdint>

#include "firmware/core/arithmetic/count_position.hpp"
#include "firmware/core/refusal.hpp"

namespace firmware {

/// Velocity, acceleration and jerk limits as increments per sample, per sample^2, per sample^3.
struct MotionLimits {
  Increment velocity = 0;
  Increment acceleration = 0;
  Increment jerk = 0;
  /// Deceleration of the ramp after a fault. If it is below the acceleration limit, that limit is used.
  Increment fault_deceleration = 0;
};

inline constexpr Increment kMostMotion = Increment{1} << (kFractionBits + 14);
/// Plans reduce a limit by up to four units, and a conversion by one: a limit of this many units is kept to 1 %.
inline constexpr Increment kLeastMotion = 512;

/// An Increment above 2^14 counts a sample (sample^2, sample^3), or too small to be represented, is refused.
constexpr Refusal check(const MotionLimits& limits) {
  const auto in_range = [](Increment value) { return value >= kLeastMotion && value <= kMostMotion; };
  if (!in_range(limits.velocity)) return Refusal::velocity_limit;
  if (!in_range(limits.acceleration)) return Refusal::acceleration_limit;
  if (!in_range(limits.jerk)) return Refusal::jerk_limit;
  // A ramp to full acceleration and back adds acceleration * steps to the velocity, where steps rounds up.
  const Increment steps = limits.acceleration / limits.jerk + 2;
  if (steps > kMostMotion / limits.acceleration) return Refusal::jerk_time;
  const Increment hard = limits.fault_deceleration;
  if (hard > limits.acceleration) {
    const Increment step = limits.acceleration < limits.jerk ? limits.acceleration : limits.jerk;
    if (!in_range(hard) || hard / step + 2 > kMostMotion / hard) return Refusal::fault_deceleration;
  }
  return Refusal::none;
}

}  // namespace firmware
