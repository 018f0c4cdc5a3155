// Latches the first fault of an axis, the worst later fault, and the motion at that moment.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/core/supervision/fault_table.hpp"
#include "firmware/core/supervision/supervisor_state.hpp"

namespace firmware {

/// Numbers are permanent: they are kept in flash.
enum class AxisActivity : std::uint8_t {
  disabled = 0,
  starting = 1,
  standing = 2,
  moving = 3,  ///< by a jog or a move
  homing = 4,
  following = 5,  ///< a path, or an experiment in closed loop
  open_loop = 6,  ///< an experiment without controller
  stopping = 7,
};
inline constexpr std::array<const char*, 8> kActivityNames{"disabled", "starting",  "standing",  "moving",
                                                           "homing",   "following", "open loop", "stopping"};

constexpr AxisActivity activity_of(SupervisorState state, bool homing, bool open_loop, bool at_rest,
                                   bool interpolated) {
  if (!outputs_are_on(state)) return AxisActivity::disabled;
  if (state == SupervisorState::starting) return AxisActivity::starting;
  if (state == SupervisorState::stopping) return AxisActivity::stopping;
  if (homing) return AxisActivity::homing;
  if (open_loop) return AxisActivity::open_loop;
  if (at_rest) return AxisActivity::standing;
  return interpolated ? AxisActivity::following : AxisActivity::moving;
}

class FaultLatch {
 public:
  constexpr void clear() { *this = {}; }

  constexpr void begin(AxisFault found, AxisActivity activity, bool homed) {
    first_ = found;
    is_new_ = true;
    activity_ = activity;
    was_homed_ = homed;
  }
  /// Keeps the first of the most severe faults that occur before the outputs are off.
  constexpr void add(AxisFault found) {
    if (found == first_ || (second_ != AxisFault::none && (!is_worse(found) || is_worse(second_)))) return;
    second_ = found;
  }

  constexpr AxisFault first() const { return first_; }
  /// none: no further fault while the first fault brought the axis to a stop.
  constexpr AxisFault second() const { return second_; }
  /// True once for each first fault.
  constexpr bool take_new() {
    if (!is_new_) return false;
    is_new_ = false;
    return true;
  }
  constexpr AxisActivity activity() const { return activity_; }
  constexpr bool was_homed() const { return was_homed_; }

 private:
  static constexpr bool is_worse(AxisFault fault) { return reaction_to(fault) != FaultReaction::ramp_stop; }

  AxisFault first_ = AxisFault::none, second_ = AxisFault::none;
  bool is_new_ = false;
  bool was_homed_ = false;
  AxisActivity activity_ = AxisActivity::disabled;
};

}  // namespace firmware
