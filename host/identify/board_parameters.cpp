#include "host/identify/board_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "host/identify/friction_law.hpp"

namespace host {

namespace {

struct Units {
  const char* travel;
  const char* speed;
  const char* effort;
  const char* inertia;
  const char* viscous;
};
constexpr Units kRotaryUnits{"mm", "rad/s", "Nm", "kg m^2", "Nm s/rad"};
constexpr Units kLinearUnits{"m", "m/s", "N", "kg", "N s/m"};

/// "Nm", "rad/s" -> "Nm/(rad/s)"; equal units cancel.
std::string per(const std::string& numerator, const std::string& denominator) {
  if (numerator == denominator) return "";
  const auto grouped = [](const std::string& unit) {
    return unit.find('/') == std::string::npos ? unit : "(" + unit + ")";
  };
  return grouped(numerator) + "/" + grouped(denominator);
}

bool is_bare_key(const std::string& name) {
  return !name.empty() &&
         std::ranges::all_of(name, [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; });
}

}  // namespace

std::vector<BoardParameter> board_parameters(const sim::DriveDescription& model, const AxisDesign& design) {
  const Units& unit = model.data.kind == sim::DriveKind::rotary ? kRotaryUnits : kLinearUnits;
  const std::string travel = unit.travel, speed = unit.speed, effort = unit.effort;
  const Eigen::Matrix3d& A = design.model.A;
  const Eigen::Vector3d& B = design.model.B;
  const auto gain = [&](int row, int column) { return column < design.Kobs.cols() ? design.Kobs(row, column) : 0.0; };
  const FrictionLaw friction = friction_law(model);

  std::vector<BoardParameter> list = {
      {"drive.sample_period", model.data.sample_period_s, "s", "control period that the gains are designed for"},
      {"drive.lead", model.data.lead, model.data.kind == sim::DriveKind::rotary ? "mm/rad" : "",
       "travel per shaft angle, rg"},
      {"drive.encoder_resolution", model.data.encoder_resolution, travel, "travel per count"},
      {"drive.dac_limit", model.data.dac_limit_V, "V", "largest command, both signs"},
      {"drive.effort_per_volt", design.axis.effort_per_volt, per(effort, "V"), "Ka*Kt"},
      {"drive.inertia", design.axis.inertia, unit.inertia, "J"},
      {"drive.viscous", design.axis.viscous, unit.viscous, "B"},
      {"model.a12", A(0, 1), per(travel, speed), "travel in a period per speed, eq. (7)"},
      {"model.a22", A(1, 1), "", "pole pwd, eq. (6)"},
      {"model.b1", B(0), per(travel, "V"), "travel in a period per command"},
      {"model.b2", B(1), per(speed, "V"), "speed gained in a period per command"},
  };
  const char* const states[] = {"position", "speed", "disturbance"};
  const std::string state_units[] = {travel, speed, "V"};
  const char* const sensors[] = {"encoder", "tachometer"};
  const std::string sensor_units[] = {travel, speed};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 2; ++column) {
      list.push_back({fmt::format("kalman.k{}{}", row + 1, column + 1), gain(row, column),
                      per(state_units[row], sensor_units[column]),
                      fmt::format("correction of the {} by the {}, eq. (43)", states[row], sensors[column])});
    }
  }
  list.push_back({"feedback.k1", design.Kc(0), per("V", travel), "on the position error, eq. (50)"});
  list.push_back({"feedback.k2", design.Kc(1), per("V", speed), "on the speed error, eq. (50)"});
  for (const bool forward : {true, false}) {
    const FrictionSideLaw& side = forward ? friction.positive : friction.negative;
    const char* sign = forward ? "positive" : "negative";
    const auto named = [&](const char* name) { return fmt::format("friction.{}_{}", name, sign); };
    list.push_back({named("static"), side.static_level, effort, "magnitude at standstill, eq. (19)"});
    list.push_back({named("coulomb"), side.coulomb, effort, "magnitude at speed, eq. (19)"});
    list.push_back({named("omega1"), side.omega1, speed, "fading of the static part, eq. (19)"});
    list.push_back({named("omega2"), side.omega2, speed, "rise of the Coulomb part, eq. (19)"});
  }
  return list;
}

std::string board_parameters_toml(const sim::DriveDescription& model, const AxisDesign& design) {
  std::string axis = model.name.empty() ? "x" : model.name;
  if (!is_bare_key(axis)) axis = fmt::format("'{}'", axis);
  std::string text = "format = \"axis-params/1\"\n";
  std::string table;
  for (const BoardParameter& parameter : board_parameters(model, design)) {
    const std::size_t dot = parameter.name.find('.');
    const std::string group = parameter.name.substr(0, dot);
    if (group != table) {
      table = group;
      text += fmt::format("\n[{}.{}]\n", axis, table);
    }
    std::string number = fmt::format("{:.9g}", parameter.value);
    if (number.find_first_of(".en") == std::string::npos) number += ".0";
    text += fmt::format("{} = {}  # {}{}{}\n", parameter.name.substr(dot + 1), number, parameter.unit,
                        parameter.unit.empty() ? "" : ": ", parameter.doc);
  }
  return text;
}

}  // namespace host
