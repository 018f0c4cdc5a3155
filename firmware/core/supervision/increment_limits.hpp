// Limits of an interpolator's increments from one sample to the next.
#pragma once

#include <cstdint>

#include "firmware/core/motion/motion_limits.hpp"

namespace firmware {

/// By the upper words of increments, 2^-16 counts.
class IncrementLimits {
 public:
  constexpr void configure(const MotionLimits& limits) {
    fastest_ = upper(limits.velocity + (limits.velocity >> 4)) + 2;  // 2: rounding
    const Increment sharpest =
        limits.acceleration < kMostMotion / 8 ? 8 * limits.acceleration : kMostMotion;  // corners
    largest_change_ = upper(sharpest) + 2;
  }

  constexpr void restart() { last_ = 0; }
  constexpr void take(Increment increment) { last_ = increment; }

  /// For the whole reference: the axis's own in the last sample, `newest`, plus the increment.
  constexpr bool allow(Increment increment, Increment newest) const {
    const std::uint32_t change = upper(increment) - upper(last_);
    const std::uint32_t whole = upper(newest) + change;
    return whole + fastest_ <= 2 * fastest_ && change + largest_change_ <= 2 * largest_change_;
  }

 private:
  static constexpr std::uint32_t upper(Increment value) { return static_cast<std::uint32_t>(value >> 32); }

  std::uint32_t fastest_ = 0, largest_change_ = 0;
  Increment last_ = 0;
};

}  // namespace firmware
