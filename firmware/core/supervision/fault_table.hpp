// Every fault in one table: its name, how it stops the axis, its cause and its remedy.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "firmware/core/axis_fault.hpp"

namespace firmware {

enum class FaultReaction : std::uint8_t {
  none,       ///< nothing to stop: the axis stays enabled
  ramp_stop,  ///< the control still works: slow down within the limits of references, then drop the enable
  /// One sensor has failed, or the loop has lost the drive, but another sensor still shows the speed: slow down with
  /// that one, then drop the enable. Without one, drop the enable at once.
  sensor_stop,
  drop_enable,  ///< the control cannot be trusted, or has lost the drive: 0 V and enable off in the same sample
};

struct FaultInfo {
  AxisFault fault = AxisFault::none;
  const char* name = nullptr;
  FaultReaction reaction = FaultReaction::none;
  const char* cause = nullptr;
  const char* remedy = nullptr;
  bool loses_position = false;  ///< counts may have been lost, so the axis is no longer homed
};

namespace fault_table {

using enum AxisFault;

/// In the order of their numbers.
inline constexpr std::array kRows = std::to_array<FaultInfo>({
    {none, "none", FaultReaction::none, "no fault", ""},
    {encoder_invalid, "encoder_invalid", FaultReaction::sensor_stop,
     "the encoder's input reports a broken wire, an illegal edge or a bus error",
     "check the encoder's cable, plug, supply and shield", true},
    {tachometer_invalid, "tachometer_invalid", FaultReaction::sensor_stop,
     "the tachometer's converter gave no reading or one out of range, although a tachometer is fitted",
     "check its cable; switch the parameter off for a drive without one"},
    {control_signal_not_a_number, "control_signal_not_a_number", FaultReaction::drop_enable,
     "the control law computed a value that is not a number",
     "design the gains again and load them; report the capture"},
    {dac_write_failed, "dac_write_failed", FaultReaction::drop_enable, "the D/A converter did not accept its value",
     "check the converter's supply and bus"},
    {parameters_missing, "parameters_missing", FaultReaction::none,
     "enable was requested before parameters were accepted", "load the parameters of this axis"},
    {following_error, "following_error", FaultReaction::sensor_stop,
     "the following error exceeds its limit at this speed: the axis is blocked or overloaded, or its drive is weak",
     "free the axis; check load and amplifier; lower acceleration; raise the limit only if the largest error of normal "
     "moves is near it"},
    {encoder_tachometer_disagreement, "encoder_tachometer_disagreement", FaultReaction::sensor_stop,
     "encoder and tachometer report different speeds: one is dead, reversed, has an offset, or its wires are swapped",
     "turn the shaft by hand and compare both readings; calibrate the tachometer; check coupling and wires", true},
    {encoder_jump, "encoder_jump", FaultReaction::sensor_stop,
     "the encoder left the drive's motion within one sample: wires cut or interchanged, counts lost, noise",
     "check shield and earth, the encoder's frequency limit and its supply", true},
    {feedback_polarity, "feedback_polarity", FaultReaction::drop_enable,
     "the drive accelerates against its command: motor or both sensors reversed, the D/A output stuck, or a load "
     "stronger than the drive",
     "swap the motor's leads, or the sign of encoder and tachometer"},
    {overspeed, "overspeed", FaultReaction::drop_enable, "the drive is faster than its limit",
     "look for a stuck D/A output or a wrong gain; check the limit against the velocity limit"},
    {travel_limit, "travel_limit", FaultReaction::ramp_stop, "the axis would leave its travel",
     "move back inside; check the target and the home position"},
    {limit_switch_positive, "limit_switch_positive", FaultReaction::ramp_stop,
     "the switch at the positive end is actuated, or its wire is broken", "move in the negative direction; check wire"},
    {limit_switch_negative, "limit_switch_negative", FaultReaction::ramp_stop,
     "the switch at the negative end is actuated, or its wire is broken", "move in the positive direction; check wire"},
    {saturation_too_long, "saturation_too_long", FaultReaction::drop_enable,
     "the D/A converter stayed at its limit: blocked axis, weak drive, or limits set too high",
     "free the axis; lower acceleration or the gains"},
    {drive_fault, "drive_fault", FaultReaction::drop_enable, "the amplifier reports a fault, or its wire is broken",
     "read the amplifier's own display"},
    {emergency_stop, "emergency_stop", FaultReaction::drop_enable, "the stop circuit is open",
     "remove the danger, release the button, clear the fault"},
    {state_not_a_number, "state_not_a_number", FaultReaction::drop_enable, "the estimator's state is not a number",
     "design the estimator again and load it; report the capture"},
    {control_overrun, "control_overrun", FaultReaction::ramp_stop, "a control period came late or took too long",
     "lower the control rate; report the capture"},
    {host_heartbeat_lost, "host_heartbeat_lost", FaultReaction::ramp_stop,
     "the host that commands the motion has gone silent: cable, program or computer",
     "reconnect; raise the time-out if the host is slow"},
    {parameter_store_damaged, "parameter_store_damaged", FaultReaction::ramp_stop,
     "the stored parameters fail their check", "load the parameters from their file and save them"},
    {supply_low, "supply_low", FaultReaction::drop_enable, "the board's supply is below its threshold",
     "check supply and wiring"},
    {reference_out_of_limits, "reference_out_of_limits", FaultReaction::ramp_stop,
     "an interpolator asked for more than the velocity limit, or for a jump",
     "check the path and its feed; check the limit"},
    {other_axis_stopped, "other_axis_stopped", FaultReaction::ramp_stop,
     "the other axis has a fault, and both stop together", "see the other axis"},
    {command_without_motion, "command_without_motion", FaultReaction::drop_enable,
     "the encoder shows no motion although the command should have moved the axis: a dead encoder, a blocked axis, a "
     "brake that holds, a motor with no or wrong current, or a tachometer that reads wrong",
     "turn the shaft by hand and watch the position; free the axis; check the motor's leads and the encoder's coupling",
     true},
    {limit_cycle, "limit_cycle", FaultReaction::drop_enable,
     "the command oscillates without commanded motion: the loop is unstable or nearly so, or its tachometer is dead",
     "turn the shaft by hand and watch the tachometer; design the gains again with less bandwidth; check inertia, "
     "delay and resonances; raise the limit only if the tachometer's noise is the cause"},
    {converter_not_as_set, "converter_not_as_set", FaultReaction::drop_enable,
     "the D/A converter's read-back differs from its setting: its supply failed, an output is shorted, it is too hot, "
     "or a wire to it is broken",
     "look at the report on the service port; check the converter's supplies, the cable to the amplifier and its load"},
    {homing_switch_not_found, "homing_switch_not_found", FaultReaction::ramp_stop,
     "the home switch did not act within the longest travel of a search",
     "check the switch and its wire; check the sign of homing.velocity, and homing.travel"},
    {homing_index_not_found, "homing_index_not_found", FaultReaction::ramp_stop, "no index pulse came within one turn",
     "check the encoder's index wires; homing.index_travel must be slightly more than a turn"},
    {homing_travel_exceeded, "homing_travel_exceeded", FaultReaction::ramp_stop,
     "the home switch stayed actuated over the longest travel of a search",
     "check the switch, which may be stuck or shorted; check the sign of homing.velocity, and homing.travel"},
    {amplifier_not_ready, "amplifier_not_ready", FaultReaction::drop_enable,
     "the amplifier did not become ready after its enable, or lost readiness, or its wire is broken",
     "read the amplifier's own display; check the ready contact and its wire; check amplifier.ready_time"},
    {index_mismatch, "index_mismatch", FaultReaction::drop_enable,
     "the counts between two index pulses are not whole turns, or a turn passed without a pulse: counts lost or "
     "gained, or a dead index line",
     "check shield and earth, the encoder's frequency limit and the index wires; check encoder.index_spacing", true},
    {moved_while_starting, "moved_while_starting", FaultReaction::drop_enable,
     "the encoder moved with the amplifier enabled and the loop open: offset of the amplifier, a stuck D/A output, a "
     "brake that does not hold, or noise on the encoder",
     "trim the amplifier's offset; measure the D/A output at 0 V; check the brake; check the encoder's shield"},
    {homing_index_near_switch, "homing_index_near_switch", FaultReaction::ramp_stop,
     "the index pulse is within an eighth of a turn of the home switch: the next homing may choose the pulse before or "
     "after it",
     "move the switch, or turn the encoder on its shaft, so that the pulse comes half a turn after the switch"},
    {drive_not_off, "drive_not_off", FaultReaction::drop_enable,
     "without an enable the amplifier reports ready, or the axis accelerates: the enable's wire is shorted or its "
     "relay welded, the ready contact is, or a weight is not held",
     "cut the amplifier's power; check the enable's wiring, the ready contact and the brake"},
    {settings_changed, "settings_changed", FaultReaction::drop_enable,
     "parameters or pin modes in the board's memory are no longer those that were set: a disturbance or a defect",
     "restart the board; if it comes again, check shield, earth and supply, then replace the board"},
});

constexpr bool is_complete() {
  for (std::size_t number = 0; number < kRows.size(); ++number)
    if (kRows[number].fault != static_cast<AxisFault>(number)) return false;
  return true;
}
static_assert(is_complete() && kRows.size() <= 64, "each fault has one row, and its number is the next");

constexpr std::array<FaultReaction, kRows.size()> reactions_alone() {
  std::array<FaultReaction, kRows.size()> reactions{};
  std::ranges::transform(kRows, reactions.begin(), &FaultInfo::reaction);
  return reactions;
}

/// One bit for each fault that loses the position.
inline constexpr std::uint64_t kPositionLost = [] {
  std::uint64_t bits = 0;
  for (const FaultInfo& row : kRows)
    if (row.loses_position) bits |= std::uint64_t{1} << static_cast<unsigned>(row.fault);
  return bits;
}();

}  // namespace fault_table

inline constexpr const auto& kFaults = fault_table::kRows;

/// For the control interrupt: the texts stay out of images that do not print them.
inline constexpr auto kFaultReactions = fault_table::reactions_alone();

constexpr const FaultInfo& fault_info(AxisFault fault) {
  const auto number = static_cast<std::size_t>(fault);
  return kFaults[number < kFaults.size() ? number : 0];
}

constexpr bool loses_position(AxisFault fault) {
  return (fault_table::kPositionLost >> static_cast<unsigned>(fault) & 1u) != 0;
}

constexpr FaultReaction reaction_to(AxisFault fault) { return kFaultReactions[static_cast<std::size_t>(fault)]; }

}  // namespace firmware
