// Executes a move plan, one sample at a time.
#pragma once

#include <cstdint>

#include "firmware/core/motion/move_plan.hpp"

namespace firmware {

/// Additions only. A move can be aborted: its acceleration then falls at the planned jerk, and a jog continues from the
/// remaining steady velocity.
class MoveProfile {
 public:
  constexpr void start(const MovePlan& plan) {
    plan_ = plan;
    measure();
    elapsed_ = 0;
    velocity_ = acceleration_ = last_ = 0;
  }

  constexpr bool is_done() const { return elapsed_ >= samples_; }

  /// True while the velocity changes according to a jerk; false in the steady stretch and before and after the move.
  constexpr bool is_accelerating() const { return !is_done() && pulse_sample() < pulse_samples_; }

  constexpr bool is_slowing_down() const { return elapsed_ >= plan_.N1; }

  /// The last increment: the velocity from which a jog continues.
  constexpr Increment velocity() const { return last_; }

  /// Reduces the present acceleration to zero. is_accelerating() shows when that is done.
  constexpr void cut_acceleration() {
    const std::int32_t executed = pulse_sample();
    if (executed >= pulse_samples_) return;
    if (plan_.N3 > executed) plan_.N3 = executed;
    if (plan_.N2 > executed) plan_.N2 = executed;
    measure();
  }

  constexpr Increment next() {
    if (is_done()) return 0;
    const std::int32_t sample = pulse_sample();
    if (sample == 0) acceleration_ = 0;
    if (sample < pulse_samples_) {
      if (sample < plan_.N3) acceleration_ += jerk_at(sample);
      if (sample >= plan_.N2) acceleration_ -= jerk_at(sample - plan_.N2);
      const Increment change = acceleration_ + (sample < plan_.acceleration_remainder ? 1 : 0);
      velocity_ += is_slowing_down() ? -change : change;
    }
    const Increment increment = velocity_ + (elapsed_ < plan_.velocity_remainder ? 1 : 0);
    ++elapsed_;
    last_ = plan_.negative ? -increment : increment;
    return last_;
  }

 private:
  constexpr void measure() {
    samples_ = plan_.samples();
    pulse_samples_ = plan_.N2 + plan_.N3 - 1;
  }
  constexpr std::int32_t pulse_sample() const { return is_slowing_down() ? elapsed_ - plan_.N1 : elapsed_; }
  constexpr Increment jerk_at(std::int32_t sample) const {
    return plan_.jerk + (sample < plan_.jerk_remainder ? 1 : 0);
  }

  MovePlan plan_{};
  std::int32_t elapsed_ = 0;
  std::int32_t samples_ = 0;
  std::int32_t pulse_samples_ = 0;
  Increment velocity_ = 0;
  Increment acceleration_ = 0;
  Increment last_ = 0;
};

}  // namespace firmware
