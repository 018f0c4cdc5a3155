// One axis's reference: a jog or a move, one increment a sample.
#pragma once

#include <cstdint>

#include "firmware/core/motion/move_plan.hpp"

namespace firmware {

/// The acceleration moves on a lattice of whole steps s (JogSteps). While step n is held or approached, the velocity
/// that braking n, n-1, ..., 1 will still add is s n (n+1) / 2; each sample takes the largest step that does not add
/// more than the remaining difference. A remainder below s, which the lattice cannot represent, is added in one last
/// sample. No division, no square root: a constant number of operations a sample.
class ReferenceGenerator {
 public:
  /// `limits` have passed check(). At rest afterwards.
  constexpr void configure(const MotionLimits& limits) {
    velocity_limit_ = limits.velocity;
    const JogSteps steps(limits);
    usual_steps_ = steps.most;
    acceleration_step_ = steps.size;
    hard_steps_ = static_cast<std::int32_t>(limits.fault_deceleration / acceleration_step_);
    reset();
  }

  /// At rest at once, without limits; for an axis that is not enabled.
  constexpr void reset() {
    most_steps_ = usual_steps_;
    velocity_ = 0;
    level();
    settling_ = false;
    jog(0);
  }

  /// From any state, up to the velocity limit. 0 slows down to standstill; a move that is already slowing down ends at
  /// its target.
  constexpr void jog(Increment velocity) {
    plan_ = {};
    aim_at(velocity > velocity_limit_ ? velocity_limit_ : (velocity < -velocity_limit_ ? -velocity_limit_ : velocity));
  }

  /// Slows down to standstill from a motion that another source made: `velocity` is its travel in the last sample. Its
  /// acceleration, of at most one jerk, ends at once.
  constexpr void stop_from(Increment velocity) {
    velocity_ = velocity;
    level();
    settling_ = true;
    jog(0);
  }

  /// All further stops, until reset(), use the fault deceleration, in the same steps.
  constexpr void brake_hard() {
    if (hard_steps_ > most_steps_) most_steps_ = hard_steps_;
  }

  /// Only from rest; otherwise returns false and changes nothing.
  constexpr bool start(const MovePlan& plan) {
    if (!at_rest()) return false;
    plan_ = plan;
    aim_at(plan.velocity);
    return true;
  }

  /// Travel of the reference in the next sample.
  constexpr Increment next() {
    if (is_steady_ && !is_planned()) return velocity_;  // nearly always
    return changing_next();
  }

  constexpr bool at_rest() const { return velocity_ == 0 && target_ == 0 && step_ == 0 && !settling_ && !is_planned(); }
  /// A move has not begun to slow down.
  constexpr bool is_planned() const { return plan_.samples > 0; }
  /// The velocity after the present acceleration has been reduced to zero, and the samples that this takes.
  constexpr Increment run_out_velocity() const { return velocity_ + (upward_ ? run_out_ : -run_out_); }
  constexpr std::int32_t run_out_samples() const { return step_; }

 private:
  constexpr void aim_at(Increment velocity) {
    target_ = velocity;
    is_steady_ = false;
  }

  [[gnu::noinline]] constexpr Increment changing_next() {
    if (!is_steady_) approach_target();
    if (!is_planned()) return velocity_;
    if (--plan_.samples == 0) aim_at(0);
    const std::int32_t unit = plan_.remainder > 0 ? 1 : plan_.remainder < 0 ? -1 : 0;
    plan_.remainder -= unit;
    return velocity_ + unit;
  }

  constexpr void approach_target() {
    if (settling_) {  // the last sample's acceleration was off the lattice: pass through zero before the next step
      settling_ = false;
      return;
    }
    const Increment missing = target_ - velocity_;
    const Increment amount = missing < 0 ? -missing : missing;
    if (step_ == 0 && amount < acceleration_step_) {
      settling_ = amount != 0;
      is_steady_ = !settling_;
      velocity_ = target_;
      return;
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
  }

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
  std::int32_t most_steps_ = 1;
  std::int32_t step_ = 0;       ///< >= 0; upward_ gives the direction
  Increment acceleration_ = 0;  ///< acceleration_step_ * step_
  Increment run_out_ = 0;       ///< velocity added while the step falls to 0, one a sample, the present one included
  Increment next_run_out_ = 1;  ///< the same with one step more
  bool upward_ = true;
  Increment velocity_ = 0;
  Increment target_ = 0;
  bool settling_ = false;
  bool is_steady_ = false;  ///< at the target, with nothing left to do
  std::int32_t usual_steps_ = 1, hard_steps_ = 1;
  MovePlan plan_{};  ///< what is left of it
};

}  // namespace firmware
