// Velocity reference with acceleration and jerk limits, re-targetable at any sample.
#pragma once

#include <cstdint>

#include "firmware/core/motion/motion_limits.hpp"

namespace firmware {

/// The acceleration moves on a lattice of whole steps: step * s, with s = acceleration limit / ceil(limit / jerk), so
/// one step a sample keeps the jerk limit and the full acceleration can be reached. While step n is held or approached,
/// the velocity that braking n, n-1, ..., 1 will still add is s n (n+1) / 2; each sample takes the largest step that
/// does not add more than the remaining difference. A remainder below s, which the lattice cannot represent, is added
/// in one last sample. No division, no square root: a constant number of operations a sample.
class JogProfile {
 public:
  /// `limits` have passed check().
  constexpr void configure(const MotionLimits& limits) {
    velocity_limit_ = limits.velocity;
    usual_steps_ = static_cast<std::int32_t>((limits.acceleration + limits.jerk - 1) / limits.jerk);
    acceleration_step_ = limits.acceleration / usual_steps_;
    hard_steps_ = static_cast<std::int32_t>(limits.fault_deceleration / acceleration_step_);
    reset();
  }

  /// Continues at `velocity`, from an acceleration of at most one jerk: the next sample has none. The target is that
  /// velocity.
  constexpr void take_over(Increment velocity) {
    velocity_ = target_ = velocity;
    level();
    settling_ = true;
    is_steady_ = false;
  }

  /// At rest from now on.
  constexpr void reset() {
    most_steps_ = usual_steps_;
    velocity_ = target_ = 0;
    level();
    settling_ = false;
    is_steady_ = false;
  }

  /// Uses the fault deceleration until reset(), on the same lattice.
  constexpr void brake_hard() {
    if (hard_steps_ > most_steps_) most_steps_ = hard_steps_;
  }

  /// Limited to the velocity limit; 0 stops.
  constexpr void set_target(Increment velocity) {
    target_ =
        velocity > velocity_limit_ ? velocity_limit_ : (velocity < -velocity_limit_ ? -velocity_limit_ : velocity);
    is_steady_ = false;
  }

  constexpr Increment next() {
    if (is_steady_) return velocity_;  // nearly always
    const Increment missing = target_ - velocity_;
    if (settling_) {  // the last sample's acceleration was off the lattice: pass through zero before the next step
      settling_ = false;
      return velocity_;
    }
    const Increment amount = missing < 0 ? -missing : missing;
    if (step_ == 0 && amount < acceleration_step_) {
      settling_ = amount != 0;
      is_steady_ = !settling_;
      velocity_ = target_;
      return velocity_;
    }
    const bool upward = missing >= 0;
    if (step_ == 0) upward_ = upward;
    if (upward_ != upward) {
      step_less();  // still moves away from the target
    } else if (step_ < most_steps_ && next_run_out_ <= amount) {
      step_more();
    } else if (run_out_ > amount) {
      step_less();
    }
    velocity_ += upward_ ? acceleration_ : -acceleration_;
    return velocity_;
  }

  /// At rest, with nothing left to do.
  constexpr bool at_rest() const { return velocity_ == 0 && target_ == 0 && step_ == 0 && !settling_; }
  /// The last sample was at the target, and all further samples will be.
  constexpr bool is_steady() const { return is_steady_; }
  constexpr Increment velocity() const { return velocity_; }
  /// The velocity after the present acceleration has been reduced to zero, and the samples that this takes.
  constexpr Increment run_out_velocity() const { return velocity_ + (upward_ ? run_out_ : -run_out_); }
  constexpr std::int32_t run_out_samples() const { return step_; }

 private:
  constexpr void level() {
    step_ = 0;
    acceleration_ = run_out_ = 0;
    next_run_out_ = acceleration_step_;
  }
  constexpr void step_more() {
    ++step_;
    acceleration_ += acceleration_step_;
    run_out_ = next_run_out_;
    next_run_out_ += acceleration_ + acceleration_step_;
  }
  constexpr void step_less() {
    --step_;
    next_run_out_ = run_out_;
    run_out_ -= acceleration_;
    acceleration_ -= acceleration_step_;
  }

  Increment velocity_limit_ = 0;
  Increment acceleration_step_ = 1;
  std::int32_t most_steps_ = 1;  // below 2^30, because check() limits the sum of that many steps of at least 16 units
  std::int32_t step_ = 0;        ///< >= 0; upward_ gives the direction
  Increment acceleration_ = 0;   ///< acceleration_step_ * step_
  Increment run_out_ = 0;        ///< velocity added while the step falls to 0, one a sample, the present one included
  Increment next_run_out_ = 1;   ///< the same with one step more
  bool upward_ = true;
  Increment velocity_ = 0;
  Increment target_ = 0;
  bool settling_ = false;
  bool is_steady_ = false;  ///< at the target, with nothing left to do
  std::int32_t usual_steps_ = 1, hard_steps_ = 1;
};

}  // namespace firmware
