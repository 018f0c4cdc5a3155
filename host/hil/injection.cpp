#include "host/hil/injection.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

namespace host {

namespace {

using firmware::AxisFault;

std::int32_t whole(double value) { return static_cast<std::int32_t>(std::lround(value)); }

template <bool hal::pc::AxisDefects::*defect>
void set(Machine& machine, std::size_t axis, double) {
  machine.wires(axis).defects.*defect = true;
}
template <bool hal::pc::AxisDefects::*defect>
void clear(Machine& machine, std::size_t axis) {
  machine.wires(axis).defects.*defect = false;
}
template <bool BoardDefects::*defect>
void set(Machine& machine, std::size_t, double) {
  machine.defects.*defect = true;
}
template <bool BoardDefects::*defect>
void clear(Machine& machine, std::size_t) {
  machine.defects.*defect = false;
}

using hal::pc::AxisDefects;
using Needs = InjectionInfo::Needs;

/// Injects a fault without a size: it is present or not.
template <auto defect>
InjectionInfo flag(const char* kind, const char* what, Needs needs, std::vector<AxisFault> names) {
  constexpr bool of_board = std::is_same_v<decltype(defect), bool BoardDefects::*>;
  return {kind, what, "", 0, 0, of_board, needs, std::move(names), set<defect>, clear<defect>};
}

const std::vector<InjectionInfo>& table() {
  static const std::vector<InjectionInfo> rows{
      flag<&AxisDefects::encoder_dead>("encoder_cut", "encoder wires cut: the counter stands still", Needs::nothing,
                                       {AxisFault::encoder_tachometer_disagreement, AxisFault::encoder_jump,
                                        AxisFault::command_without_motion, AxisFault::encoder_invalid}),
      flag<&AxisDefects::encoder_fault_open>("encoder_fault_open",
                                             "the wire of the encoder receivers' fault output is cut",
                                             Needs::encoder_fault_input, {AxisFault::encoder_invalid}),
      flag<&AxisDefects::encoder_reported_bad>("encoder_invalid", "the encoder's readings are invalid", Needs::nothing,
                                               {AxisFault::encoder_invalid}),
      flag<&AxisDefects::encoder_swapped>(
          "encoder_swapped", "encoder channels interchanged", Needs::nothing,
          {AxisFault::encoder_tachometer_disagreement, AxisFault::encoder_jump, AxisFault::feedback_polarity,
           AxisFault::following_error, AxisFault::moved_while_starting}),
      {"encoder_noise",
       "noise on the encoder, even over +-value",
       "counts",
       80,
       40,
       false,
       Needs::nothing,
       {AxisFault::encoder_jump, AxisFault::encoder_tachometer_disagreement, AxisFault::moved_while_starting},
       [](Machine& m, std::size_t axis, double value) { m.wires(axis).defects.encoder_noise = whole(value); },
       [](Machine& m, std::size_t axis) { m.wires(axis).defects.encoder_noise = 0; }},
      {"counts_lost",
       "encoder counts lost at once",
       "counts",
       200,
       60,
       false,
       Needs::nothing,
       {AxisFault::encoder_jump, AxisFault::encoder_tachometer_disagreement},
       [](Machine& m, std::size_t axis, double value) { m.wires(axis).defects.encoder_lost += whole(value); },
       [](Machine&, std::size_t) {}},
      flag<&AxisDefects::tachometer_dead>("tachometer_dead", "tachometer reads 0", Needs::nothing,
                                          {AxisFault::encoder_tachometer_disagreement, AxisFault::encoder_jump,
                                           AxisFault::limit_cycle, AxisFault::command_without_motion}),
      flag<&AxisDefects::tachometer_reversed>(
          "tachometer_reversed", "tachometer with its leads interchanged", Needs::nothing,
          {AxisFault::encoder_tachometer_disagreement, AxisFault::encoder_jump, AxisFault::command_without_motion}),
      {"tachometer_offset",
       "tachometer reads too much",
       "rad/s",
       30,
       26,
       false,
       Needs::nothing,
       {AxisFault::encoder_tachometer_disagreement, AxisFault::encoder_jump, AxisFault::command_without_motion},
       [](Machine& m, std::size_t axis, double value) {
         m.wires(axis).defects.tachometer_offset = whole(value / hal::pc::AxisWiring{}.tachometer_resolution);
       },
       [](Machine& m, std::size_t axis) { m.wires(axis).defects.tachometer_offset = 0; }},
      flag<&AxisDefects::motor_reversed>("motor_reversed", "motor leads interchanged", Needs::nothing,
                                         {AxisFault::feedback_polarity, AxisFault::following_error,
                                          AxisFault::overspeed, AxisFault::command_without_motion}),
      {"dac_stuck",
       "D/A converter stuck at a voltage",
       "V",
       10,
       3,
       false,
       Needs::nothing,
       {AxisFault::following_error, AxisFault::overspeed, AxisFault::saturation_too_long, AxisFault::feedback_polarity,
        AxisFault::command_without_motion, AxisFault::moved_while_starting},
       [](Machine& m, std::size_t axis, double value) {
         m.wires(axis).defects.dac_stuck = true;
         m.wires(axis).defects.dac_stuck_code = whole(value / m.plant(axis).data().dac_resolution_V);
       },
       clear<&AxisDefects::dac_stuck>},
      flag<&AxisDefects::dac_unhealthy>("dac_lost", "the D/A converter loses its registers", Needs::nothing,
                                        {AxisFault::converter_not_as_set}),
      flag<&AxisDefects::blocked>("blocked", "the axis is blocked", Needs::nothing,
                                  {AxisFault::following_error, AxisFault::saturation_too_long, AxisFault::encoder_jump,
                                   AxisFault::command_without_motion}),
      {"runaway_command",
       "the interpolator accelerates without end",
       "mm/s^2",
       3000,
       500,
       false,
       Needs::nothing,
       {AxisFault::reference_out_of_limits, AxisFault::travel_limit, AxisFault::overspeed},
       [](Machine& m, std::size_t axis, double value) { m.defects.runaway_mm_s2[axis] = value; },
       [](Machine& m, std::size_t axis) { m.defects.runaway_mm_s2[axis] = 0.0; }},
      flag<&AxisDefects::drive_faulted>("drive_fault", "the amplifier fails and says so", Needs::nothing,
                                        {AxisFault::drive_fault}),
      flag<&AxisDefects::unready>("unready", "the amplifier's ready contact opens", Needs::ready_input,
                                  {AxisFault::amplifier_not_ready}),
      flag<&AxisDefects::ready_stuck>("ready_stuck", "the amplifier's ready contact is welded: found once disabled",
                                      Needs::ready_input, {AxisFault::drive_not_off}),
      flag<&AxisDefects::enable_stuck>("enable_stuck", "the amplifier's enable is welded: found once disabled",
                                       Needs::ready_input, {AxisFault::drive_not_off}),
      flag<&AxisDefects::enable_open>(
          "enable_open", "the amplifier does not get its enable", Needs::nothing,
          {AxisFault::amplifier_not_ready, AxisFault::command_without_motion, AxisFault::following_error,
           AxisFault::saturation_too_long, AxisFault::feedback_polarity, AxisFault::encoder_jump}),
      {"amplifier_stuck",
       "the amplifier gives a current of its own, without an enable too",
       "V",
       10,
       3,
       false,
       Needs::ready_input,
       {AxisFault::drive_not_off, AxisFault::following_error, AxisFault::overspeed, AxisFault::saturation_too_long,
        AxisFault::feedback_polarity, AxisFault::command_without_motion, AxisFault::moved_while_starting},
       [](Machine& m, std::size_t axis, double value) {
         m.wires(axis).defects.amplifier_stuck = true;
         m.wires(axis).defects.amplifier_stuck_code = whole(value / m.plant(axis).data().dac_resolution_V);
       },
       clear<&AxisDefects::amplifier_stuck>},
      {"amplifier_offset",
       "the amplifier adds to its command",
       "V",
       2,
       1.4,
       false,
       Needs::open_loop,
       {AxisFault::moved_while_starting, AxisFault::following_error, AxisFault::overspeed,
        AxisFault::saturation_too_long, AxisFault::feedback_polarity, AxisFault::command_without_motion},
       [](Machine& m, std::size_t axis, double value) {
         m.wires(axis).defects.amplifier_offset = whole(value / m.plant(axis).data().dac_resolution_V);
       },
       [](Machine& m, std::size_t axis) { m.wires(axis).defects.amplifier_offset = 0; }},
      flag<&AxisDefects::brake_stuck>(
          "brake_stuck", "the brake does not let go", Needs::brake,
          {AxisFault::following_error, AxisFault::saturation_too_long, AxisFault::encoder_jump,
           AxisFault::command_without_motion, AxisFault::encoder_tachometer_disagreement}),
      flag<&AxisDefects::positive_end_reached>("positive_limit", "the switch at the positive end acts", Needs::nothing,
                                               {AxisFault::limit_switch_positive}),
      flag<&AxisDefects::negative_end_reached>("negative_limit", "the switch at the negative end acts", Needs::nothing,
                                               {AxisFault::limit_switch_negative}),
      flag<&BoardDefects::emergency_stop>("emergency_stop", "the emergency stop is pressed", Needs::nothing,
                                          {AxisFault::emergency_stop}),
      flag<&BoardDefects::power_lost>("power_lost", "mains lost: no current, supply sinks", Needs::nothing,
                                      {AxisFault::supply_low}),
      flag<&BoardDefects::host_silent>("usb_gone", "the host falls silent", Needs::nothing,
                                       {AxisFault::host_heartbeat_lost}),
      {"control_late",
       "the control interrupt misses periods",
       "periods",
       5,
       1,
       true,
       Needs::nothing,
       {AxisFault::control_overrun},
       [](Machine& m, std::size_t, double value) { m.lose_periods(whole(value)); },
       [](Machine&, std::size_t) {}},
      flag<&BoardDefects::store_damaged>("store_damaged", "the parameter store is damaged", Needs::nothing,
                                         {AxisFault::parameter_store_damaged}),
  };
  return rows;
}

}  // namespace

std::span<const InjectionInfo> injections() { return table(); }

const InjectionInfo* find_injection(std::string_view kind) {
  const auto row = std::ranges::find(table(), kind, &InjectionInfo::kind);
  return row == table().end() ? nullptr : &*row;
}

}  // namespace host
