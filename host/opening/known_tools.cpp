#include "host/opening/known_tools.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>

#include "host/import/joint_states.hpp"
#include "host/opening/name_words.hpp"

namespace host {

namespace {

struct ToolColumn {
  std::string_view ending;  ///< end of the column's name
  ChannelQuantity quantity;
  bool is_reference;
  std::string_view unit;  ///< empty if there is none
};

/// ODrive firmware 0.5.1 and later: turns, turns/s, A (docs.odriverobotics.com, interface reference).
constexpr ToolColumn kOdrive[] = {
    {"pos_estimate", ChannelQuantity::position, false, "turns"},
    {"pos_rel", ChannelQuantity::position, false, "turns"},
    {"pos_abs", ChannelQuantity::position, false, "turns"},
    {"vel_estimate", ChannelQuantity::speed, false, "turns/s"},
    {".vel", ChannelQuantity::speed, false, "turns/s"},
    {"Iq_measured", ChannelQuantity::current, false, "A"},
    {"Iq_setpoint", ChannelQuantity::current, true, "A"},
    {"input_pos", ChannelQuantity::position, true, "turns"},
    {"pos_setpoint", ChannelQuantity::position, true, "turns"},
    {"input_vel", ChannelQuantity::speed, true, "turns/s"},
    {"vel_setpoint", ChannelQuantity::speed, true, "turns/s"},
    {"torque_setpoint", ChannelQuantity::torque, true, "Nm"},
    {"torque_estimate", ChannelQuantity::torque, false, "Nm"},
    {"effective_torque_setpoint", ChannelQuantity::torque, true, "Nm"},
};

/// moteus registers: revolutions, revolutions/s, Nm, A (github.com/mjbots/moteus, docs/reference.md).
constexpr ToolColumn kMoteus[] = {
    {"position", ChannelQuantity::position, false, "turns"},
    {"velocity", ChannelQuantity::speed, false, "turns/s"},
    {"torque", ChannelQuantity::torque, false, "Nm"},
    {"q_current", ChannelQuantity::current, false, "A"},
    {"q_A", ChannelQuantity::current, false, "A"},
    {"d_current", ChannelQuantity::other, false, "A"},
    {"d_A", ChannelQuantity::other, false, "A"},
    {"control_position", ChannelQuantity::position, true, "turns"},
    {"control_velocity", ChannelQuantity::speed, true, "turns/s"},
    {"temperature", ChannelQuantity::temperature, false, "degC"},
    {"voltage", ChannelQuantity::other, false, "V"},
    {"motor_temperature", ChannelQuantity::temperature, false, "degC"},
};

/// VESC Tool: ms since midnight, A, degrees (github.com/vedderb/vesc_tool, vescinterface.cpp).
constexpr ToolColumn kVesc[] = {
    {"ms_today", ChannelQuantity::time, false, "ms"},
    {"q_axis_current", ChannelQuantity::current, false, "A"},
    {"current_motor", ChannelQuantity::other, false, "A"},
    {"current_in", ChannelQuantity::other, false, "A"},
    {"d_axis_current", ChannelQuantity::other, false, "A"},
    {"encoder_position", ChannelQuantity::position, false, "deg"},
    {"erpm", ChannelQuantity::other, false, ""},
    {"tachometer", ChannelQuantity::other, false, ""},
    {"tachometer_abs", ChannelQuantity::other, false, ""},
    {"temp_motor", ChannelQuantity::temperature, false, "degC"},
    {"speed_meters_per_sec", ChannelQuantity::other, false, ""},
    {"q_axis_voltage", ChannelQuantity::other, false, "V"},
    {"d_axis_voltage", ChannelQuantity::other, false, "V"},
    {"ms_today_setup", ChannelQuantity::other, false, ""},
    {"ms_today_imu", ChannelQuantity::other, false, ""},
    {"tacho_meters", ChannelQuantity::other, false, ""},
    {"temp_mos_max", ChannelQuantity::other, false, ""},
    {"current_in_setup", ChannelQuantity::other, false, ""},
    {"current_motor_setup", ChannelQuantity::other, false, ""},
    {"gnss_posTime", ChannelQuantity::other, false, ""},
};

/// Betaflight's Blackbox: the terms of the PID and the battery are not the current or torque of an axis
/// (blackbox_decode.c of github.com/betaflight/blackbox-tools, csv-export-worker.js of blackbox-log-viewer).
void apply_betaflight(const Log& log, std::vector<ChannelName>& names) {
  static constexpr std::string_view kOthers[] = {"axisP[",         "axisI[",           "axisD[",
                                                 "axisF[",         "axisS[",           "vbatLatest",
                                                 "amperageLatest", "energyCumulative", "currentVirtual"};
  for (std::size_t k = 0; k < log.columns.size(); ++k) {
    const std::string& name = log.columns[k].name;
    if (std::ranges::any_of(kOthers, [&](std::string_view start) { return name.starts_with(start); }))
      names[k].quantity = ChannelQuantity::other;
    if (name != "time") continue;
    names[k].unit_text = "us";
    names[k].unit = unit_named("us");
  }
}

bool has(const Log& log, std::string_view part) {
  return std::ranges::any_of(log.columns,
                             [&](const LogColumn& column) { return column.name.find(part) != std::string::npos; });
}

bool has_named(const Log& log, std::string_view name) {
  return std::ranges::any_of(log.columns, [&](const LogColumn& column) { return column.name == name; });
}

void apply(const Log& log, std::span<const ToolColumn> known, std::vector<ChannelName>& names) {
  for (std::size_t k = 0; k < log.columns.size(); ++k)
    for (const ToolColumn& column : known) {
      const std::string& name = log.columns[k].name;
      const bool whole =
          name == column.ending || (name.ends_with(column.ending) && name.size() > column.ending.size() &&
                                    name[name.size() - column.ending.size() - 1] == '.');
      if (!whole && !(name.ends_with(column.ending) && column.ending.size() > 8)) continue;
      names[k].quantity = column.quantity;
      names[k].is_reference = column.is_reference;
      names[k].is_weak = names[k].is_second = false;
      names[k].makes_torque = column.ending.starts_with("q_") || column.ending.starts_with("Iq");
      if (names[k].unit_text.empty() && !column.unit.empty()) {
        names[k].unit_text = column.unit;
        names[k].unit = unit_named(column.unit);
      }
      break;
    }
}

/// Whether the log is from older ODrive firmware, which uses counts, with 8192 per turn.
bool are_counts(const Log& log) {
  constexpr double kMoreThanTurns = 3000.0;
  for (const LogColumn& column : log.columns)
    if (column.name.ends_with("pos_estimate"))
      for (const double value : column.values)
        if (std::abs(value) > kMoreThanTurns) return true;
  return false;
}

/// "x-output": the axis letter at the start of a signal's name; empty if there is none.
std::string axis_of_signal(std::string_view name) {
  const std::vector<std::string> words = words_of(name);
  const bool letter = words.size() > 1 && words.front().size() == 1 &&
                      std::string_view("xyzabcuvw").find(words.front().front()) != std::string_view::npos;
  return letter ? words.front() : "";
}

/// Pins of LinuxCNC's HAL: reference, feedback and output of a control loop.
void apply_hal(const Log& log, std::vector<ChannelName>& names) {
  for (std::size_t k = 0; k < log.columns.size(); ++k) {
    const std::string text = log.columns[k].name + " " + log.columns[k].kind;
    const auto says = [&](std::string_view part) { return text.find(part) != std::string::npos; };
    ChannelName& name = names[k];
    if (name.axis.empty()) name.axis = axis_of_signal(log.columns[k].name);
    if (says(".output")) {
      name.quantity = ChannelQuantity::voltage;
      name.is_reference = name.is_weak = true;
    } else if (says(".command") || says("-cmd")) {
      name.quantity = says("vel") ? ChannelQuantity::speed : ChannelQuantity::position;
      name.is_reference = true;
    } else if (says(".feedback") || says("-fb")) {
      name.quantity = says("vel") ? ChannelQuantity::speed : ChannelQuantity::position;
      name.is_measured = true;
      name.is_reference = false;
    }
  }
}

/// Joint states: the unit determines the quantity, and the text before the last point is the joint.
void apply_joint_states(const Log& log, std::vector<ChannelName>& names) {
  struct JointColumn {
    std::string_view unit;
    ChannelQuantity quantity;
    UnitMeaning turning, sliding;
  };
  static constexpr JointColumn kColumns[] = {
      {kJointPositionUnit, ChannelQuantity::position, {Dimension::angle}, {Dimension::length, 1e3}},
      {kJointSpeedUnit, ChannelQuantity::speed, {Dimension::angular_speed}, {Dimension::linear_speed, 1e3}},
      {kJointEffortUnit, ChannelQuantity::torque, {Dimension::torque}, {Dimension::force}}};
  for (std::size_t k = 0; k < log.columns.size(); ++k)
    for (const JointColumn& column : kColumns) {
      if (log.columns[k].unit != column.unit) continue;
      names[k] = {};
      names[k].quantity = column.quantity;
      names[k].unit = column.turning;
      names[k].sliding_unit = column.sliding;
      names[k].unit_text = column.unit;
      names[k].axis = log.columns[k].name.substr(0, log.columns[k].name.rfind('.'));
    }
}

}  // namespace

void apply_known_tools(Log& log, std::vector<ChannelName>& names) {
  for (std::size_t k = 0; k < log.columns.size(); ++k)  // captures of dSPACE: X is the time
    if (log.columns[k].name.ends_with(".X.Data")) names[k].quantity = ChannelQuantity::time;
  const bool odrive = has(log, "pos_estimate") || has(log, "vel_estimate") || has(log, "Iq_measured");
  if (odrive && !are_counts(log)) apply(log, kOdrive, names);
  const bool moteus =
      !odrive &&
      (has(log, "q_current") || has_named(log, "q_A") || (has_named(log, "fault") && has_named(log, "torque"))) &&
      has(log, "position") && has(log, "velocity");
  if (moteus) apply(log, kMoteus, names);
  const bool vesc = has_named(log, "ms_today");
  if (vesc) apply(log, kVesc, names);
  if (log.layout == "ros2-joint-states") apply_joint_states(log, names);
  if (log.layout == "halsampler" || log.layout == "halscope") apply_hal(log, names);
  const bool betaflight = has_named(log, "loopIteration") && has(log, "axisP[");
  if (betaflight) apply_betaflight(log, names);
  if (log.layout == "table")
    log.layout = odrive ? "odrive" : moteus ? "moteus" : vesc ? "vesc" : betaflight ? "betaflight" : log.layout;
}

}  // namespace host
