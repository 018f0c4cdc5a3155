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
  Quantity quantity;
  bool is_reference;
  std::string_view unit;  ///< empty if there is none
};

/// ODrive firmware 0.5.1 and later: turns, turns/s, A (docs.odriverobotics.com, interface reference).
constexpr ToolColumn kOdrive[] = {
    {"pos_estimate", Quantity::position, false, "turns"}, {"pos_rel", Quantity::position, false, "turns"},
    {"pos_abs", Quantity::position, false, "turns"},      {"vel_estimate", Quantity::speed, false, "turns/s"},
    {".vel", Quantity::speed, false, "turns/s"},          {"Iq_measured", Quantity::current, false, "A"},
    {"Iq_setpoint", Quantity::current, true, "A"},        {"input_pos", Quantity::position, true, "turns"},
    {"pos_setpoint", Quantity::position, true, "turns"},  {"input_vel", Quantity::speed, true, "turns/s"},
    {"vel_setpoint", Quantity::speed, true, "turns/s"},   {"torque_setpoint", Quantity::torque, true, "Nm"},
    {"torque_estimate", Quantity::torque, false, "Nm"},   {"effective_torque_setpoint", Quantity::torque, true, "Nm"},
};

/// moteus registers: revolutions, revolutions/s, Nm, A (github.com/mjbots/moteus, docs/reference.md).
constexpr ToolColumn kMoteus[] = {
    {"position", Quantity::position, false, "turns"},
    {"velocity", Quantity::speed, false, "turns/s"},
    {"torque", Quantity::torque, false, "Nm"},
    {"q_current", Quantity::current, false, "A"},
    {"q_A", Quantity::current, false, "A"},
    {"d_current", Quantity::other, false, "A"},
    {"d_A", Quantity::other, false, "A"},
    {"control_position", Quantity::position, true, "turns"},
    {"control_velocity", Quantity::speed, true, "turns/s"},
    {"temperature", Quantity::temperature, false, "degC"},
    {"voltage", Quantity::other, false, "V"},
    {"motor_temperature", Quantity::temperature, false, "degC"},
};

/// VESC Tool: ms since midnight, A, degrees (github.com/vedderb/vesc_tool, vescinterface.cpp).
constexpr ToolColumn kVesc[] = {
    {"ms_today", Quantity::time, false, "ms"},
    {"q_axis_current", Quantity::current, false, "A"},
    {"current_motor", Quantity::other, false, "A"},
    {"current_in", Quantity::other, false, "A"},
    {"d_axis_current", Quantity::other, false, "A"},
    {"encoder_position", Quantity::position, false, "deg"},
    {"erpm", Quantity::other, false, ""},
    {"tachometer", Quantity::other, false, ""},
    {"tachometer_abs", Quantity::other, false, ""},
    {"temp_motor", Quantity::temperature, false, "degC"},
    {"speed_meters_per_sec", Quantity::other, false, ""},
    {"q_axis_voltage", Quantity::other, false, "V"},
    {"d_axis_voltage", Quantity::other, false, "V"},
    {"ms_today_setup", Quantity::other, false, ""},
    {"ms_today_imu", Quantity::other, false, ""},
    {"tacho_meters", Quantity::other, false, ""},
    {"temp_mos_max", Quantity::other, false, ""},
    {"current_in_setup", Quantity::other, false, ""},
    {"current_motor_setup", Quantity::other, false, ""},
    {"gnss_posTime", Quantity::other, false, ""},
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
      names[k].quantity = Quantity::other;
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
      name.quantity = Quantity::voltage;
      name.is_reference = name.is_weak = true;
    } else if (says(".command") || says("-cmd")) {
      name.quantity = says("vel") ? Quantity::speed : Quantity::position;
      name.is_reference = true;
    } else if (says(".feedback") || says("-fb")) {
      name.quantity = says("vel") ? Quantity::speed : Quantity::position;
      name.is_measured = true;
      name.is_reference = false;
    }
  }
}

/// Joint states: the unit determines the quantity, and the text before the last point is the joint.
void apply_joint_states(const Log& log, std::vector<ChannelName>& names) {
  struct JointColumn {
    std::string_view unit;
    Quantity quantity;
    UnitMeaning turning, sliding;
  };
  static constexpr JointColumn kColumns[] = {
      {kJointPositionUnit, Quantity::position, {Dimension::angle}, {Dimension::length, 1e3}},
      {kJointSpeedUnit, Quantity::speed, {Dimension::angular_speed}, {Dimension::linear_speed, 1e3}},
      {kJointEffortUnit, Quantity::torque, {Dimension::torque}, {Dimension::force}}};
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
    if (log.columns[k].name.ends_with(".X.Data")) names[k].quantity = Quantity::time;
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
