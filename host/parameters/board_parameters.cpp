#include "host/parameters/board_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <numbers>
#include <utility>

#include "firmware/app/parameters/parameter_table.hpp"
#include "host/identify/friction_law.hpp"
#include "host/known_by_current.hpp"

namespace host {

namespace {

bool is_bare_key(const std::string& name) {
  return !name.empty() &&
         std::ranges::all_of(name, [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; });
}

std::string value_text(const firmware::ParameterInfo& info, double value) {
  if (info.type == firmware::ParameterType::toggle) return value != 0.0 ? "true" : "false";
  std::string number = fmt::format("{:.9g}", value);
  if (number.find_first_of(".en") == std::string::npos) number += ".0";
  return number;
}

/// The monitors' initial values suit a rotary drive with a screw. For a linear drive they are converted to m, with the
/// paper's 10 mm per turn. Thresholds of commands follow from the converter's limit and from the friction that a
/// command must overcome.
void append_monitors(bool rotary, double dac_limit_V, double friction_V, std::vector<BoardParameter>& list) {
  constexpr double kLead_m_per_rad = 0.010 / (2.0 * std::numbers::pi);
  const double length = rotary ? 1.0 : 1e-3;
  const double speed = rotary ? 1.0 : kLead_m_per_rad;
  for (const firmware::ThresholdRow& row : firmware::kThresholdRows) {
    const auto add = [&](double unit) {
      list.push_back({std::string(row.name), static_cast<double>(row.initial) * unit});
    };
    if (row.quantity == firmware::Quantity::length) add(length);
    if (row.quantity == firmware::Quantity::velocity) add(speed);
    if (row.quantity == firmware::Quantity::length_per_velocity) add(length / speed);
  }
  list.push_back({"monitor.polarity_command", std::clamp(1.3 * friction_V, 0.3 * dac_limit_V, 0.8 * dac_limit_V)});
  list.push_back({"monitor.oscillation", 0.25 * dac_limit_V});
}

}  // namespace

ReferenceLimits ReferenceLimits::usual_for(sim::DriveKind kind) {
  const ReferenceLimits in_mm;
  if (kind == sim::DriveKind::rotary) return in_mm;
  return {1e-3 * in_mm.velocity, 1e-3 * in_mm.acceleration, 1e-3 * in_mm.jerk};
}

std::vector<BoardParameter> board_parameters(const sim::DriveDescription& model, const AxisDesign& design,
                                             const ReferenceLimits& limits) {
  require_volts(model.data, model.name, "a board");
  const bool rotary = model.data.kind == sim::DriveKind::rotary;
  const Eigen::Matrix3d& A = design.model.A;
  const Eigen::Vector3d& B = design.model.B;
  const auto gain = [&](int row, int column) { return column < design.Kobs.cols() ? design.Kobs(row, column) : 0.0; };
  const FrictionLaw friction = friction_law(model);
  const double viscous =
      rigid_axis(model).viscous - design.axis.viscous;  // mostly zero: the design uses the model's value
  // Friction is smoothed through zero speed over 0.01 turns/s (0.06 rad/s), for a linear drive over 1e-4 m/s.
  const double blend = rotary ? 0.06 : 1e-4;

  std::vector<BoardParameter> list = {
      {"drive.fitted", 1.0},
      {"drive.sample_period", model.data.sample_period_s},
      {"drive.lead", model.data.lead},
      {"drive.encoder_resolution", model.data.encoder_resolution},
      {"drive.dac_resolution", model.data.dac_resolution_V},
      {"drive.dac_limit", model.data.dac_limit_V},
      {"drive.effort_per_volt", design.axis.effort_per_volt},
      {"tachometer.fitted", design.Kobs.cols() == 2 ? 1.0 : 0.0},
      {"model.a12", A(0, 1)},
      {"model.a22", A(1, 1)},
      {"model.b1", B(0)},
      {"model.b2", B(1)},
  };
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 2; ++column)
      list.push_back({fmt::format("kalman.k{}{}", row + 1, column + 1), gain(row, column)});
  list.push_back({"feedback.k1", design.Kc(0)});
  list.push_back({"feedback.k2", design.Kc(1)});
  list.push_back({"feedback.cancel_disturbance", 1.0});
  list.push_back({"feedforward.zero_phase", design.used.zero_phase ? 1.0 : 0.0});
  list.push_back({"feedforward.friction", 1.0});
  for (const bool forward : {true, false}) {
    const FrictionSideLaw& side = forward ? friction.positive : friction.negative;
    const char* sign = forward ? "positive" : "negative";
    const auto named = [&](const char* name) { return fmt::format("friction.{}_{}", name, sign); };
    list.push_back({named("static"), side.static_level});
    list.push_back({named("coulomb"), side.coulomb});
    list.push_back({named("viscous"), viscous});
    list.push_back({named("omega1"), side.omega1});
    list.push_back({named("omega2"), side.omega2});
  }
  list.push_back({"friction.blend", blend});
  list.push_back({"limits.velocity", limits.velocity});
  list.push_back({"limits.acceleration", limits.acceleration});
  list.push_back({"limits.jerk", limits.jerk});
  const double hardest = std::max({friction.positive.static_level, friction.positive.coulomb,
                                   friction.negative.static_level, friction.negative.coulomb});
  append_monitors(rotary, model.data.dac_limit_V, hardest / design.axis.effort_per_volt, list);
  return list;
}

std::string board_parameters_toml(const sim::DriveDescription& model, const AxisDesign& design) {
  return board_parameters_toml(model, design, ReferenceLimits::usual_for(model.data.kind));
}

std::string board_parameters_toml(const sim::DriveDescription& model, const AxisDesign& design,
                                  const ReferenceLimits& limits) {
  const bool rotary = model.data.kind == sim::DriveKind::rotary;
  std::string axis = model.name.empty() ? "x" : model.name;
  if (!is_bare_key(axis)) axis = fmt::format("'{}'", axis);
  std::string text = "format = \"axis-params/1\"\n";
  std::string table;
  for (const BoardParameter& parameter : board_parameters(model, design, limits)) {
    const firmware::ParameterInfo& info =
        *std::ranges::find(firmware::kParameters, parameter.name, &firmware::ParameterInfo::name);
    const std::size_t dot = parameter.name.find('.');
    const std::string group = parameter.name.substr(0, dot);
    if (group != table) {
      table = group;
      text += fmt::format("\n[{}.{}]\n", axis, table);
    }
    const std::string_view unit = rotary ? info.unit : info.linear_unit;
    const bool has_unit = !unit.empty() && unit != "1";
    text += fmt::format("{} = {}  # {}{}{}\n", parameter.name.substr(dot + 1), value_text(info, parameter.value),
                        has_unit ? unit : "", has_unit ? ": " : "", info.doc);
  }
  return text;
}

}  // namespace host
