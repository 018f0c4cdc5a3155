// Every fault in one table, by its number.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "firmware/core/supervision/monitored_faults.hpp"

namespace firmware {

/// Faults that are found where their cause is handled; faults found by monitors are declared in monitored_faults.hpp.
namespace fault_table {

inline constexpr std::array kOthers = std::to_array<FaultInfo>({
    {.fault = AxisFault::none, .name = "none", .cause = "no fault", .remedy = "", .reaction = FaultReaction::none},
    {.fault = AxisFault::encoder_invalid,
     .name = "encoder_invalid",
     .cause = "the encoder's input reports a broken wire, an illegal edge or a bus error",
     .remedy = "check the encoder's cable, plug, supply and shield",
     .reaction = FaultReaction::sensor_stop,
     .loses_position = true},
    {.fault = AxisFault::tachometer_invalid,
     .name = "tachometer_invalid",
     .cause = "the tachometer's converter gave no reading or one out of range, although a tachometer is fitted",
     .remedy = "check its cable; switch the parameter off for a drive without one",
     .reaction = FaultReaction::sensor_stop},
    {.fault = AxisFault::control_signal_not_a_number,
     .name = "control_signal_not_a_number",
     .cause = "the control law computed a value that is not a number",
     .remedy = "design the gains again and load them; report the capture",
     .reaction = FaultReaction::drop_enable},
    {.fault = AxisFault::dac_write_failed,
     .name = "dac_write_failed",
     .cause = "the D/A converter did not accept its value",
     .remedy = "check the converter's supply and bus",
     .reaction = FaultReaction::drop_enable},
    {.fault = AxisFault::parameters_missing,
     .name = "parameters_missing",
     .cause = "enable was requested before parameters were accepted",
     .remedy = "load the parameters of this axis",
     .reaction = FaultReaction::none},
    {.fault = AxisFault::limit_switch_positive,
     .name = "limit_switch_positive",
     .cause = "the switch at the positive end is actuated, or its wire is broken",
     .remedy = "move in the negative direction; check wire",
     .reaction = FaultReaction::ramp_stop},
    {.fault = AxisFault::limit_switch_negative,
     .name = "limit_switch_negative",
     .cause = "the switch at the negative end is actuated, or its wire is broken",
     .remedy = "move in the positive direction; check wire",
     .reaction = FaultReaction::ramp_stop},
    {.fault = AxisFault::drive_fault,
     .name = "drive_fault",
     .cause = "the amplifier reports a fault, or its wire is broken",
     .remedy = "read the amplifier's own display",
     .reaction = FaultReaction::drop_enable},
    {.fault = AxisFault::emergency_stop,
     .name = "emergency_stop",
     .cause = "the stop circuit is open",
     .remedy = "remove the danger, release the button, clear the fault",
     .reaction = FaultReaction::drop_enable},
    {.fault = AxisFault::state_not_a_number,
     .name = "state_not_a_number",
     .cause = "the estimator's state is not a number",
     .remedy = "design the estimator again and load it; report the capture",
     .reaction = FaultReaction::drop_enable},
    {.fault = AxisFault::control_overrun,
     .name = "control_overrun",
     .cause = "a control period came late or took too long",
     .remedy = "lower the control rate; report the capture",
     .reaction = FaultReaction::ramp_stop},
    {.fault = AxisFault::host_heartbeat_lost,
     .name = "host_heartbeat_lost",
     .cause = "the host that commands the motion has gone silent: cable, program or computer",
     .remedy = "reconnect; raise the time-out if the host is slow",
     .reaction = FaultReaction::ramp_stop},
    {.fault = AxisFault::parameter_store_damaged,
     .name = "parameter_store_damaged",
     .cause = "the stored parameters fail their check",
     .remedy = "load the parameters from their file and save them",
     .reaction = FaultReaction::ramp_stop},
    {.fault = AxisFault::supply_low,
     .name = "supply_low",
     .cause = "the board's supply is below its threshold",
     .remedy = "check supply and wiring",
     .reaction = FaultReaction::drop_enable},
    {.fault = AxisFault::reference_out_of_limits,
     .name = "reference_out_of_limits",
     .cause = "an interpolator asked for more than the velocity limit, or for a jump",
     .remedy = "check the path and its feed; check the limit",
     .reaction = FaultReaction::ramp_stop},
    {.fault = AxisFault::other_axis_stopped,
     .name = "other_axis_stopped",
     .cause = "the other axis has a fault, and both stop together",
     .remedy = "see the other axis",
     .reaction = FaultReaction::ramp_stop},
    {.fault = AxisFault::homing_switch_not_found,
     .name = "homing_switch_not_found",
     .cause = "the home switch did not act within the longest travel of a search",
     .remedy = "check the switch and its wire; check the sign of homing.velocity, and homing.travel",
     .reaction = FaultReaction::ramp_stop},
    {.fault = AxisFault::homing_index_not_found,
     .name = "homing_index_not_found",
     .cause = "no index pulse came within one turn",
     .remedy = "check the encoder's index wires; homing.index_travel must be slightly more than a turn",
     .reaction = FaultReaction::ramp_stop},
    {.fault = AxisFault::homing_index_near_switch,
     .name = "homing_index_near_switch",
     .cause = "the index pulse is within an eighth of a turn of the home switch: the next homing may choose the pulse "
              "before or after it",
     .remedy =
         "move the switch, or turn the encoder on its shaft, so that the pulse comes half a turn after the switch",
     .reaction = FaultReaction::ramp_stop},
    {.fault = AxisFault::homing_travel_exceeded,
     .name = "homing_travel_exceeded",
     .cause = "the home switch stayed actuated over the longest travel of a search",
     .remedy = "check the switch, which may be stuck or shorted; check the sign of homing.velocity, and homing.travel",
     .reaction = FaultReaction::ramp_stop},
    {.fault = AxisFault::amplifier_not_ready,
     .name = "amplifier_not_ready",
     .cause = "the amplifier did not become ready after its enable, or lost readiness, or its wire is broken",
     .remedy = "read the amplifier's own display; check the ready contact and its wire; check amplifier.ready_time",
     .reaction = FaultReaction::drop_enable},
    {.fault = AxisFault::drive_not_off,
     .name = "drive_not_off",
     .cause = "without an enable the amplifier reports ready, or the axis accelerates: the enable's wire is shorted or "
              "its relay welded, the ready contact is, or a weight is not held",
     .remedy = "cut the amplifier's power; check the enable's wiring, the ready contact and the brake",
     .reaction = FaultReaction::drop_enable},
    {.fault = AxisFault::moved_while_starting,
     .name = "moved_while_starting",
     .cause = "the encoder moved with the amplifier enabled and the loop open: offset of the amplifier, a stuck D/A "
              "output, a brake that does not hold, or noise on the encoder",
     .remedy =
         "trim the amplifier's offset; measure the D/A output at 0 V; check the brake; check the encoder's shield",
     .reaction = FaultReaction::drop_enable},
});

inline constexpr std::size_t kCount = [] {
  std::size_t count = kOthers.size();
  MonitoredFaults::for_each([&](auto declared) {
    using Declaration = decltype(declared);
    count += Declaration::kFaults.size();
  });
  return count;
}();

/// A row for every number below kCount; without a name if a number was left out or given twice.
constexpr std::array<FaultInfo, kCount> by_number() {
  std::array<FaultInfo, kCount> rows{};
  const auto put = [&rows](const FaultInfo& row) {
    const auto number = static_cast<std::size_t>(row.fault);
    if (number < kCount) rows[number] = row;
  };
  for (const FaultInfo& row : kOthers) put(row);
  MonitoredFaults::for_each([&](auto declared) {
    using Declaration = decltype(declared);
    for (const FaultInfo& row : Declaration::kFaults) put(row);
  });
  return rows;
}

}  // namespace fault_table

/// All faults, in the order of their numbers.
inline constexpr std::array<FaultInfo, fault_table::kCount> kFaults = fault_table::by_number();

namespace fault_table {

static_assert(std::ranges::none_of(kFaults, [](const FaultInfo& row) { return row.name == nullptr; }),
              "each fault has one row, and its number is the next");
static_assert(kFaults.size() <= 64);

constexpr std::array<FaultReaction, kFaults.size()> reactions_alone() {
  std::array<FaultReaction, kFaults.size()> reactions{};
  std::ranges::transform(kFaults, reactions.begin(), &FaultInfo::reaction);
  return reactions;
}

/// One bit for each fault that loses the position.
inline constexpr std::uint64_t kPositionLost = [] {
  std::uint64_t bits = 0;
  for (const FaultInfo& row : kFaults)
    if (row.loses_position) bits |= std::uint64_t{1} << static_cast<unsigned>(row.fault);
  return bits;
}();

}  // namespace fault_table

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
