// One axis's reference: a jog or a move, one increment a sample.
#pragma once

#include <cstdint>

#include "firmware/core/motion/jog_profile.hpp"
#include "firmware/core/motion/move_profile.hpp"

namespace firmware {

enum class MotionMode : std::uint8_t {
  jog,           ///< velocity mode; target 0 is standstill
  move,          ///< playing a plan
  leaving_move,  ///< the acceleration of an aborted move falls to zero, then the jog continues
};

class ReferenceGenerator {
 public:
  /// `limits` have passed check(). At rest afterwards.
  constexpr void configure(const MotionLimits& limits) {
    jog_.configure(limits);
    reset();
  }

  /// At rest at once, without limits; for an axis that is not enabled.
  constexpr void reset() {
    jog_.reset();
    pending_jog_ = 0;
    mode_ = MotionMode::jog;
  }

  /// From any state; within the limits.
  constexpr void jog(Increment velocity) {
    pending_jog_ = velocity;
    if (mode_ == MotionMode::jog) {
      jog_.set_target(velocity);
    } else if (mode_ == MotionMode::move) {
      move_.cut_acceleration();
      mode_ = MotionMode::leaving_move;
    }
  }

  /// Slows down to standstill. A move that is already slowing down keeps to its plan, and so ends at its target.
  constexpr void stop() {
    if (mode_ == MotionMode::move && move_.is_slowing_down()) return;
    jog(0);
  }

  /// Slows down to standstill from a motion that another source made: `velocity` is its travel in the last sample. Its
  /// acceleration ends at once.
  constexpr void stop_from(Increment velocity) {
    jog_.take_over(velocity);
    jog_.set_target(0);
    pending_jog_ = 0;
    mode_ = MotionMode::jog;
  }

  /// All further stops, until reset(), use the fault deceleration. Planned moves keep their own.
  constexpr void brake_hard() { jog_.brake_hard(); }

  /// Only from rest; otherwise returns false and changes nothing.
  constexpr bool start(const MovePlan& plan) {
    if (!at_rest()) return false;
    move_.start(plan);
    mode_ = MotionMode::move;
    return true;
  }

  /// Travel of the reference in the next sample.
  constexpr Increment next() {
    if (mode_ == MotionMode::jog && jog_.is_steady()) return jog_.velocity();  // nearly always
    return changing_next();
  }

  constexpr bool at_rest() const {
    return mode_ == MotionMode::jog ? jog_.at_rest() : mode_ == MotionMode::move && move_.is_done();
  }
  constexpr MotionMode mode() const { return mode_; }
  constexpr const JogProfile& jog_profile() const { return jog_; }

 private:
  [[gnu::noinline]] constexpr Increment changing_next() {
    if (mode_ == MotionMode::leaving_move && !move_.is_accelerating()) {
      jog_.take_over(move_.velocity());
      jog_.set_target(pending_jog_);
      mode_ = MotionMode::jog;
    }
    if (mode_ == MotionMode::move && move_.is_done()) {
      jog_.take_over(0);
      mode_ = MotionMode::jog;
    }
    return mode_ == MotionMode::jog ? jog_.next() : move_.next();
  }

  MotionMode mode_ = MotionMode::jog;
  JogProfile jog_;
  MoveProfile move_;
  Increment pending_jog_ = 0;
};

}  // namespace firmware
