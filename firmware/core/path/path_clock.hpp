// The time of a path: samples of the path for one sample of the board, changed gently.
#pragma once

#include "firmware/core/motion/jog_profile.hpp"
#include "firmware/core/motion/stopping_distance.hpp"

namespace firmware {

/// A path is slowed down by its clock, so that it is never left. A clock that changes by A / V of the axes' limits a
/// sample slows an axis at its velocity limit down as quickly as that axis may, and a slower one no quicker; likewise
/// J / V. Rates are increments of one sample a sample, 0 to kOneCount.
class PathClock {
 public:
  /// Of an axis's limits the path may need most itself. With these shares for the clock both together stay near them:
  /// in 10,000 programs with holds above by an eighth of the acceleration and a third of the jerk at most
  /// (tests/host/path/path_slowing_test.cpp). Gentler ones hardly lower that, and a stop takes longer.
  static constexpr float kAccelerationShare = 0.75F, kJerkShare = 0.25F;

  /// `acceleration` a sample^2, `jerk` a sample^3, both in 1..kOneCount. Standing.
  constexpr void configure(Increment acceleration, Increment jerk) {
    MotionLimits limits{kOneCount, acceleration, jerk};
    constexpr Increment kSlowest = kOneCount >> 24;  // at 20 kHz a ramp of half a minute
    for (Increment* limit : {&limits.acceleration, &limits.jerk}) {
      if (*limit < kSlowest) *limit = kSlowest;
      if (*limit > kOneCount) *limit = kOneCount;
    }
    if (limits.jerk > limits.acceleration) limits.jerk = limits.acceleration;
    rate_.configure(limits);
    stopping_.configure(limits);
    longest_stop_ = stopping_.counts(kOneCount, static_cast<std::int32_t>(limits.acceleration / limits.jerk) + 1) + 2;
  }

  constexpr void set_target(Increment rate) {
    if (rate == target_) return;
    target_ = rate;
    rate_.set_target(rate);
  }
  /// At this rate from the next sample on: where nothing moves, nothing jumps.
  constexpr void begin(Increment rate) {
    rate_.take_over(rate);
    target_ = rate;
  }
  /// Lets the change run out, at once: the rate stays near what it is. May be asked again in each sample.
  constexpr void level_out() { set_target(rate_.levelled_velocity()); }

  /// Path time of the next sample.
  constexpr Increment next() { return rate_.next(); }

  constexpr Increment rate() const { return rate_.velocity(); }
  constexpr bool stands() const { return rate_.at_rest(); }
  constexpr bool is_steady() const { return rate_.is_steady(); }
  constexpr bool is_slowing() const { return rate_.is_falling(); }

  /// Samples of the path that a stop from now on takes at most.
  constexpr std::int64_t way_of_stop() const {
    return stopping_.counts(rate_.run_out_velocity(), rate_.run_out_samples()) + 2;
  }

  /// From any rate.
  constexpr std::int64_t longest_stop() const { return longest_stop_; }

  constexpr void stand() {
    rate_.reset();
    target_ = 0;
  }

 private:
  JogProfile rate_;
  StoppingDistance stopping_;
  Increment target_ = 0;
  std::int64_t longest_stop_ = 0;
};

}  // namespace firmware
