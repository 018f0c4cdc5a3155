// Stopping distance of a jog.
#pragma once

#include <bit>
#include <cstdint>

#include "firmware/core/motion/motion_limits.hpp"

namespace firmware {

/// Twice the stopping time from a path's highest speed, samples: an upper bound for every stop.
constexpr std::int32_t longest_ramp(const MotionLimits& limits) {
  const std::int64_t ramp = 2 * (limits.velocity / limits.acceleration + limits.acceleration / limits.jerk + 2);
  constexpr std::int64_t kMost = std::int64_t{1} << 30;
  return static_cast<std::int32_t>((ramp < kMost ? ramp : kMost) + (ramp < kMost ? ramp >> 3 : 0));
}

/// An upper bound, in whole numbers and without division: v^2 / (2 a) + v a / (2 j). It is the stopping distance from
/// the steady velocity v if the stop reaches the acceleration limit, and more than the distance v sqrt(v / j) if it
/// does not.
class StoppingDistance {
 public:
  /// `limits` have passed check().
  constexpr void configure(const MotionLimits& limits) {
    const auto acceleration = static_cast<std::uint64_t>(limits.acceleration);
    exponent_ = 63 - std::countl_zero(acceleration);
    const std::uint64_t leading = exponent_ > 31 ? acceleration >> (exponent_ - 31) : acceleration << (31 - exponent_);
    reciprocal_ = (std::uint64_t{1} << 62) / leading + 1;
    jerk_samples_ = limits.acceleration / limits.jerk + 1;
  }

  /// Counts, from a steady `velocity` whose stop begins after `delay` samples.
  constexpr std::int64_t counts(Increment velocity, std::int32_t delay) const {
    const auto speed = static_cast<std::uint64_t>(velocity < 0 ? -velocity : velocity);
    const auto ramp_samples = static_cast<std::int64_t>(((speed >> 31) + 1) * reciprocal_ >> exponent_) + 1;
    constexpr std::int64_t kMost = std::int64_t{1} << 30;
    const std::int64_t samples = ramp_samples + jerk_samples_ + 2 * (std::int64_t{delay} + 1);
    return ((static_cast<std::int64_t>(speed >> 32) + 1) * (samples < kMost ? samples : kMost) >> 17) + 1;
  }

 private:
  std::uint64_t reciprocal_ = 0;  ///< 2^(31 + exponent) / acceleration
  std::int32_t exponent_ = 0;     ///< exponent of the acceleration limit's leading bit
  std::int64_t jerk_samples_ = 0;
};

}  // namespace firmware
