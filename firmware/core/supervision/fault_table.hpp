// Every fault in one table: what it is called, what causes it, what mends it, and how the axis is stopped.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "firmware/core/axis_fault.hpp"

namespace firmware {

enum class FaultReaction : std::uint8_t {
  none,         ///< nothing to stop: the axis is not let go
  ramp_stop,    ///< the control still works: slow down within the limits of references, then drop the enable
  drop_enable,  ///< the control cannot be trusted, or has lost the drive: 0 V and enable off in the same sample
};

struct FaultInfo {
  AxisFault fault;
  const char* name;
  const char* cause;
  const char* remedy;
  FaultReaction reaction;
};

/// In the order of their numbers.
inline constexpr std::array<FaultInfo, 32> kFaults{{
    {AxisFault::none, "none", "no fault", "", FaultReaction::none},
    {AxisFault::encoder_invalid, "encoder_invalid",
     "the encoder's input reports a broken wire, an illegal edge or a bus error",
     "check the encoder's cable, plug, supply and shield", FaultReaction::drop_enable},
    {AxisFault::tachometer_invalid, "tachometer_invalid",
     "the tachometer's converter gave no reading or one out of range, although a tachometer is fitted",
     "check its cable; switch the parameter off for a drive without one", FaultReaction::drop_enable},
    {AxisFault::control_signal_not_a_number, "control_signal_not_a_number",
     "the control law computed a value that is no number", "design the gains again and load them; report the capture",
     FaultReaction::drop_enable},
    {AxisFault::dac_write_failed, "dac_write_failed", "the D/A converter did not take its word",
     "check the converter's supply and bus", FaultReaction::drop_enable},
    {AxisFault::parameters_missing, "parameters_missing", "enable was asked for before parameters were accepted",
     "load the parameters of this axis", FaultReaction::none},
    {AxisFault::following_error, "following_error",
     "the axis is farther from its reference than it may be at this speed: blocked, overloaded, or its drive is weak",
     "free the axis; check load and amplifier; lower acceleration; raise the limit only if the high-water mark of "
     "sound moves is near it",
     FaultReaction::drop_enable},
    {AxisFault::encoder_tachometer_disagreement, "encoder_tachometer_disagreement",
     "encoder and tachometer report different speeds: one is dead, reversed, offset, or its wires are swapped",
     "turn the shaft by hand and compare both readings; calibrate the tachometer; check coupling and wires",
     FaultReaction::drop_enable},
    {AxisFault::encoder_jump, "encoder_jump",
     "the encoder left the drive's motion within one sample: wires cut or interchanged, counts lost, noise",
     "check shield and earth, the encoder's frequency limit and its supply", FaultReaction::drop_enable},
    {AxisFault::feedback_polarity, "feedback_polarity",
     "the drive accelerates against its command: motor or both sensors the wrong way round, the D/A output stuck, or a "
     "load that is stronger than the drive",
     "swap the motor's leads, or the sign of encoder and tachometer", FaultReaction::drop_enable},
    {AxisFault::overspeed, "overspeed", "the drive is faster than its limit",
     "look for a stuck D/A output or a wrong gain; check the limit against the velocity limit",
     FaultReaction::drop_enable},
    {AxisFault::travel_limit, "travel_limit", "the axis would leave its travel",
     "move back inside; check the target and the home position", FaultReaction::ramp_stop},
    {AxisFault::limit_switch_positive, "limit_switch_positive",
     "the switch at the positive end is actuated, or its wire is broken", "move in the negative direction; check wire",
     FaultReaction::ramp_stop},
    {AxisFault::limit_switch_negative, "limit_switch_negative",
     "the switch at the negative end is actuated, or its wire is broken", "move in the positive direction; check wire",
     FaultReaction::ramp_stop},
    {AxisFault::saturation_too_long, "saturation_too_long",
     "the D/A converter stayed at its limit: blocked axis, weak drive, or limits that ask too much",
     "free the axis; lower acceleration or the gains", FaultReaction::drop_enable},
    {AxisFault::drive_fault, "drive_fault", "the amplifier reports a fault, or its wire is broken",
     "read the amplifier's own display", FaultReaction::drop_enable},
    {AxisFault::emergency_stop, "emergency_stop", "the stop circuit is open",
     "remove the danger, release the button, clear the fault", FaultReaction::drop_enable},
    {AxisFault::state_not_a_number, "state_not_a_number", "the estimator's state is no number",
     "design the estimator again and load it; report the capture", FaultReaction::drop_enable},
    {AxisFault::control_overrun, "control_overrun", "a control period came late or took too long",
     "lower the control rate; report the capture", FaultReaction::ramp_stop},
    {AxisFault::host_heartbeat_lost, "host_heartbeat_lost",
     "the host that commands the motion has gone silent: cable, program or computer",
     "connect again; raise the time-out if the host is slow", FaultReaction::ramp_stop},
    {AxisFault::parameter_store_damaged, "parameter_store_damaged", "the stored parameters fail their check",
     "load the parameters from their file and save them", FaultReaction::ramp_stop},
    {AxisFault::supply_low, "supply_low", "the board's supply is below its threshold", "check supply and wiring",
     FaultReaction::drop_enable},
    {AxisFault::reference_out_of_limits, "reference_out_of_limits",
     "an interpolator asked for more than the velocity limit, or for a jump",
     "check the path and its feed; check the limit", FaultReaction::ramp_stop},
    {AxisFault::other_axis_stopped, "other_axis_stopped", "the other axis has a fault, and both stop together",
     "see the other axis", FaultReaction::ramp_stop},
    {AxisFault::command_without_motion, "command_without_motion",
     "the command should long have moved the axis, and the encoder does not show it: a dead encoder, an axis that is "
     "blocked, a motor without current or with the wrong one",
     "turn the shaft by hand and watch the position; free the axis; check the motor's leads and the encoder's coupling",
     FaultReaction::drop_enable},
    {AxisFault::limit_cycle, "limit_cycle",
     "the feedback swings the command to and fro without motion that asks for it: the loop is unstable or nearly so",
     "design the gains again with less bandwidth; check inertia, delay and resonances; raise the limit only if the "
     "tachometer's noise is what swings",
     FaultReaction::drop_enable},
    {AxisFault::converter_not_as_set, "converter_not_as_set",
     "the D/A converter, read back, is not as it was set: its supply broke down, an output is shorted, it is too hot, "
     "or a "
     "wire to it is broken",
     "look at the report on the service port; check the converter's supplies, the cable to the amplifier and its load",
     FaultReaction::drop_enable},
    {AxisFault::homing_switch_not_found, "homing_switch_not_found",
     "the home switch did not act within the longest way of a search",
     "check the switch and its wire; check the sign of homing.velocity, and homing.travel", FaultReaction::ramp_stop},
    {AxisFault::homing_index_not_found, "homing_index_not_found",
     "no index pulse came within the way that one turn takes",
     "check the encoder's index wires; homing.index_travel is a turn and a little more", FaultReaction::ramp_stop},
    {AxisFault::homing_travel_exceeded, "homing_travel_exceeded",
     "the home switch stayed actuated over the longest way of a search",
     "check the switch, which may be stuck or shorted; check the sign of homing.velocity, and homing.travel",
     FaultReaction::ramp_stop},
    {AxisFault::amplifier_not_ready, "amplifier_not_ready",
     "the amplifier did not become ready after its enable, or was ready no longer, or its wire is broken",
     "read the amplifier's own display; check the ready contact and its wire; check amplifier.ready_time",
     FaultReaction::drop_enable},
    {AxisFault::index_mismatch, "index_mismatch",
     "the counts between two index pulses are no whole turns, or a turn passed without a pulse: counts lost or gained, "
     "or a dead index line",
     "check shield and earth, the encoder's frequency limit and the index wires; check encoder.index_spacing",
     FaultReaction::drop_enable},
}};

namespace fault_table {

constexpr bool numbers_are_positions() {
  for (std::size_t i = 0; i < kFaults.size(); ++i)
    if (static_cast<std::size_t>(kFaults[i].fault) != i) return false;
  return true;
}
static_assert(numbers_are_positions(), "each fault has one row, in the order of the numbers");

}  // namespace fault_table

namespace fault_table {

constexpr std::array<FaultReaction, kFaults.size()> reactions_alone() {
  std::array<FaultReaction, kFaults.size()> reactions{};
  std::ranges::transform(kFaults, reactions.begin(), &FaultInfo::reaction);
  return reactions;
}

}  // namespace fault_table

/// For the control interrupt: the texts stay out of images that do not print them.
inline constexpr auto kFaultReactions = fault_table::reactions_alone();

constexpr const FaultInfo& fault_info(AxisFault fault) {
  const auto number = static_cast<std::size_t>(fault);
  return kFaults[number < kFaults.size() ? number : 0];
}

/// After these nobody knows whether all counts were counted: the axis is no longer homed.
constexpr bool loses_position(AxisFault fault) {
  return fault == AxisFault::encoder_invalid || fault == AxisFault::encoder_jump ||
         fault == AxisFault::encoder_tachometer_disagreement || fault == AxisFault::command_without_motion ||
         fault == AxisFault::index_mismatch;
}

constexpr FaultReaction reaction_to(AxisFault fault) { return kFaultReactions[static_cast<std::size_t>(fault)]; }

}  // namespace firmware
