// The steps of a jog's acceleration, and how long it takes to reach a velocity.
#pragma once

#include <cstdint>

#include "firmware/core/motion/motion_limits.hpp"

namespace firmware {

/// Steps of a jog's acceleration: `most` of them make the acceleration limit, and one a sample keeps the jerk limit.
/// Two units of each are left to a move, which adds one unit to some of its samples (MovePlan).
struct JogSteps {
  std::int32_t most = 1;  ///< below 2^30, because check() limits the sum of that many steps
  Increment size = 1;

  constexpr JogSteps() = default;
  /// `limits` have passed check().
  explicit constexpr JogSteps(const MotionLimits& limits)
      : most(static_cast<std::int32_t>((limits.acceleration + limits.jerk - 1) / limits.jerk)),
        size(limits.acceleration / most - 2) {}

  /// Samples from rest until a jog has reached this velocity >= 0 and could change it again.
  constexpr std::int64_t ramp_samples(Increment velocity) const {
    const Increment whole = velocity / size;
    std::int64_t highest = 0;  // step: the root of `whole`, or `most`
    for (int bit = 29; bit >= 0; --bit) {
      const std::int64_t larger = highest | (std::int64_t{1} << bit);
      if (larger <= most && larger * larger <= whole) highest = larger;
    }
    if (highest == 0) highest = 1;
    constexpr int kRemainder = 3;  // samples: no acceleration, what the steps leave, no acceleration
    return (whole + highest - 1) / highest + highest - 1 + kRemainder;
  }
};

}  // namespace firmware
