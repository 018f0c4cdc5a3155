#include "host/hil/injection.hpp"

#include <algorithm>
#include <cmath>

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

const std::vector<InjectionInfo>& table() {
  static const std::vector<InjectionInfo> rows{
      {"encoder_cut",
       "encoder wires cut: the counter stands still",
       "",
       0,
       0,
       false,
       {AxisFault::encoder_tachometer_disagreement, AxisFault::encoder_jump, AxisFault::command_without_motion},
       set<&AxisDefects::encoder_dead>,
       clear<&AxisDefects::encoder_dead>},
      {"encoder_invalid",
       "encoder wires cut, and the input's monitor reports it",
       "",
       0,
       0,
       false,
       {AxisFault::encoder_invalid},
       set<&AxisDefects::encoder_reported_bad>,
       clear<&AxisDefects::encoder_reported_bad>},
      {"encoder_swapped",
       "encoder channels interchanged",
       "",
       0,
       0,
       false,
       {AxisFault::encoder_tachometer_disagreement, AxisFault::encoder_jump, AxisFault::feedback_polarity,
        AxisFault::following_error},
       set<&AxisDefects::encoder_swapped>,
       clear<&AxisDefects::encoder_swapped>},
      {"encoder_noise",
       "noise on the encoder, even over +-value",
       "counts",
       80,
       40,
       false,
       {AxisFault::encoder_jump, AxisFault::encoder_tachometer_disagreement},
       [](Machine& m, std::size_t axis, double value) { m.wires(axis).defects.encoder_noise = whole(value); },
       [](Machine& m, std::size_t axis) { m.wires(axis).defects.encoder_noise = 0; }},
      {"counts_lost",
       "encoder counts lost at once",
       "counts",
       200,
       60,
       false,
       {AxisFault::encoder_jump, AxisFault::encoder_tachometer_disagreement},
       [](Machine& m, std::size_t axis, double value) { m.wires(axis).defects.encoder_lost += whole(value); },
       [](Machine&, std::size_t) {}},
      {"tachometer_dead",
       "tachometer reads 0",
       "",
       0,
       0,
       false,
       {AxisFault::encoder_tachometer_disagreement, AxisFault::encoder_jump},
       set<&AxisDefects::tachometer_dead>,
       clear<&AxisDefects::tachometer_dead>},
      {"tachometer_reversed",
       "tachometer with its leads interchanged",
       "",
       0,
       0,
       false,
       {AxisFault::encoder_tachometer_disagreement, AxisFault::encoder_jump},
       set<&AxisDefects::tachometer_reversed>,
       clear<&AxisDefects::tachometer_reversed>},
      {"tachometer_offset",
       "tachometer reads too much",
       "rad/s",
       30,
       26,
       false,
       {AxisFault::encoder_tachometer_disagreement, AxisFault::encoder_jump},
       [](Machine& m, std::size_t axis, double value) {
         m.wires(axis).defects.tachometer_offset = whole(value / hal::pc::AxisWiring{}.tachometer_resolution);
       },
       [](Machine& m, std::size_t axis) { m.wires(axis).defects.tachometer_offset = 0; }},
      {"motor_reversed",
       "motor leads interchanged",
       "",
       0,
       0,
       false,
       {AxisFault::feedback_polarity, AxisFault::following_error, AxisFault::overspeed,
        AxisFault::command_without_motion},
       set<&AxisDefects::motor_reversed>,
       clear<&AxisDefects::motor_reversed>},
      {"dac_stuck",
       "D/A converter stuck at a voltage",
       "V",
       10,
       3,
       false,
       {AxisFault::following_error, AxisFault::overspeed, AxisFault::saturation_too_long, AxisFault::feedback_polarity,
        AxisFault::command_without_motion},
       [](Machine& m, std::size_t axis, double value) {
         m.wires(axis).defects.dac_stuck = true;
         m.wires(axis).defects.dac_stuck_code = whole(value / m.plant(axis).data().dac_resolution_V);
       },
       clear<&AxisDefects::dac_stuck>},
      {"dac_lost",
       "the D/A converter loses its registers",
       "",
       0,
       0,
       false,
       {AxisFault::converter_not_as_set},
       set<&AxisDefects::dac_unhealthy>,
       clear<&AxisDefects::dac_unhealthy>},
      {"blocked",
       "the axis is blocked",
       "",
       0,
       0,
       false,
       {AxisFault::following_error, AxisFault::saturation_too_long, AxisFault::encoder_jump,
        AxisFault::command_without_motion},
       set<&AxisDefects::blocked>,
       clear<&AxisDefects::blocked>},
      {"runaway_command",
       "the interpolator accelerates without end",
       "mm/s^2",
       3000,
       500,
       false,
       {AxisFault::reference_out_of_limits, AxisFault::travel_limit, AxisFault::overspeed},
       [](Machine& m, std::size_t axis, double value) { m.defects.runaway_mm_s2[axis] = value; },
       [](Machine& m, std::size_t axis) { m.defects.runaway_mm_s2[axis] = 0.0; }},
      {"drive_fault",
       "the amplifier fails and says so",
       "",
       0,
       0,
       false,
       {AxisFault::drive_fault},
       set<&AxisDefects::drive_faulted>,
       clear<&AxisDefects::drive_faulted>},
      {"positive_limit",
       "the switch at the positive end acts",
       "",
       0,
       0,
       false,
       {AxisFault::limit_switch_positive},
       set<&AxisDefects::positive_end_reached>,
       clear<&AxisDefects::positive_end_reached>},
      {"negative_limit",
       "the switch at the negative end acts",
       "",
       0,
       0,
       false,
       {AxisFault::limit_switch_negative},
       set<&AxisDefects::negative_end_reached>,
       clear<&AxisDefects::negative_end_reached>},
      {"emergency_stop",
       "the emergency stop is pressed",
       "",
       0,
       0,
       true,
       {AxisFault::emergency_stop},
       set<&BoardDefects::emergency_stop>,
       clear<&BoardDefects::emergency_stop>},
      {"power_lost",
       "mains lost: no current, supply sinks",
       "",
       0,
       0,
       true,
       {AxisFault::supply_low},
       set<&BoardDefects::power_lost>,
       clear<&BoardDefects::power_lost>},
      {"usb_gone",
       "the host falls silent",
       "",
       0,
       0,
       true,
       {AxisFault::host_heartbeat_lost},
       set<&BoardDefects::host_silent>,
       clear<&BoardDefects::host_silent>},
      {"control_late",
       "the control interrupt misses periods",
       "periods",
       5,
       1,
       true,
       {AxisFault::control_overrun},
       [](Machine& m, std::size_t, double value) { m.lose_periods(whole(value)); },
       [](Machine&, std::size_t) {}},
      {"store_damaged",
       "the parameter store is damaged",
       "",
       0,
       0,
       true,
       {AxisFault::parameter_store_damaged},
       set<&BoardDefects::store_damaged>,
       clear<&BoardDefects::store_damaged>},
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
