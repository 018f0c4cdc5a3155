#include "host/parameters/compensation_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <iterator>
#include <numbers>

#include "firmware/app/parameters/axis_values.hpp"
#include "host/identify/friction_law.hpp"
#include "host/parameters/parameter_names.hpp"
#include "sim/harmonic.hpp"
#include "sim/second_mass.hpp"

namespace host {

namespace {

using Parameters = std::vector<CompensationParameter>;

/// One sine over the travel, in the board's form.
struct BoardHarmonic {
  double cosine, sine, period;

  double amplitude() const { return std::hypot(cosine, sine); }
};

/// All orders of all effects of a kind, largest first.
std::vector<BoardHarmonic> board_harmonics(const sim::DriveDescription& model, std::string_view kind) {
  std::vector<BoardHarmonic> harmonics;
  for (const sim::EffectEntry& entry : model.effects) {
    if (entry.kind != kind) continue;
    for (const sim::HarmonicTerm& term : sim::harmonics_of(entry))
      harmonics.push_back({term.cosine, term.sine, entry.at("period") / term.order});
  }
  std::ranges::stable_sort(harmonics, std::ranges::greater{}, &BoardHarmonic::amplitude);
  return harmonics;
}

void append_cogging(const sim::DriveDescription& model, Parameters& list) {
  std::vector<BoardHarmonic> harmonics = board_harmonics(model, "cogging");
  list.push_back({"cogging.on", harmonics.empty() ? 0.0 : 1.0});
  if (harmonics.empty()) return;
  harmonics.resize(firmware::kCoggingHarmonics, {0.0, 0.0, harmonics.front().period});
  for (std::size_t i = 0; i < harmonics.size(); ++i) {
    list.push_back({fmt::format("cogging.cosine_{}", i + 1), harmonics[i].cosine});
    list.push_back({fmt::format("cogging.sine_{}", i + 1), harmonics[i].sine});
    list.push_back({fmt::format("cogging.period_{}", i + 1), harmonics[i].period});
  }
}

void append_contact(const sim::DriveDescription& model, Parameters& list) {
  const sim::EffectEntry* contact = model.find("presliding");
  list.push_back({"presliding.on", contact != nullptr ? 1.0 : 0.0});
  if (contact != nullptr) {
    list.push_back({"presliding.stiffness", contact->at("sigma0")});
    list.push_back({"presliding.damping", contact->at("sigma1")});
  }
  const std::vector<BoardHarmonic> along_travel = board_harmonics(model, "position_dependent_friction");
  list.push_back({"position_friction.on", along_travel.empty() ? 0.0 : 1.0});
  if (along_travel.empty()) return;
  list.push_back({"position_friction.cosine", along_travel.front().cosine});
  list.push_back({"position_friction.sine", along_travel.front().sine});
  list.push_back({"position_friction.period", along_travel.front().period});
}

void append_backlash(const sim::DriveDescription& model, Parameters& list) {
  const sim::EffectEntry* backlash = model.find("backlash");
  const double gap = backlash != nullptr ? backlash->at("gap") : 0.0;
  list.push_back({"backlash.on", gap > 0.0 ? 1.0 : 0.0});
  if (gap <= 0.0) return;
  list.push_back({"backlash.gap", gap});
  // The stiffness between two masses follows from this resonance; it is loaded by the friction on the table's side.
  const sim::EffectEntry* inertia = model.find("inertia");
  const double load = backlash->at("load_fraction");
  const double rate = 2.0 * std::numbers::pi * backlash->at("resonance");
  const double stiffness = inertia != nullptr ? inertia->at("J") * load * (1.0 - load) * rate * rate : 0.0;
  const FrictionLaw friction = friction_law(model);
  const double share = sim::second_mass_of(*backlash).load_friction;
  const double level = 0.5 * share * (friction.positive.coulomb + friction.negative.coulomb);
  list.push_back({"backlash.wind_up", stiffness > 0.0 ? model.data.lead * level / stiffness : 0.0});
}

void append_calibration(const sim::DriveDescription& model, Parameters& list) {
  const TachometerReading tachometer = tachometer_reading(model);
  list.push_back({"calibration.tachometer_gain", tachometer.gain});
  list.push_back({"calibration.tachometer_offset", tachometer.offset});
}

std::string as_key(const std::string& name) {
  const bool is_bare =
      std::ranges::all_of(name, [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; });
  return is_bare ? name : fmt::format("'{}'", name);
}

}  // namespace

Parameters compensation_parameters(const sim::DriveDescription& model) {
  Parameters list;
  append_calibration(model, list);
  append_cogging(model, list);
  append_contact(model, list);
  append_backlash(model, list);
  return list;
}

std::string compensation_toml(const sim::DriveDescription& model) {
  return parameter_tables(model, compensation_parameters(model));
}

std::string parameter_tables(const sim::DriveDescription& model, const Parameters& list) {
  const std::string axis = as_key(model.name.empty() ? "x" : model.name);
  std::string text, table;
  for (const CompensationParameter& parameter : list) {
    const firmware::ParameterInfo& info = info_at(require_place("x." + parameter.name));
    const std::size_t dot = parameter.name.find('.');
    if (const std::string group = parameter.name.substr(0, dot); group != table) {
      table = group;
      text += fmt::format("\n[{}.{}]\n", axis, table);
    }
    const std::string_view unit = model.data.kind == sim::DriveKind::rotary ? info.unit : info.linear_unit;
    const bool has_unit = !unit.empty() && unit != "1";
    text += fmt::format("{} = {}  # {}{}{}\n", parameter.name.substr(dot + 1),
                        value_text(info, static_cast<float>(parameter.value)), has_unit ? unit : "",
                        has_unit ? ": " : "", info.doc);
  }
  return text;
}

firmware::CompensationParameters<float> core_compensation(const sim::DriveDescription& model) {
  firmware::ParameterValues values;
  const auto set = [&](const std::string& name, double value) {
    values.set(require_place("x." + name), static_cast<float>(value));
  };
  set("drive.sample_period", model.data.sample_period_s);
  set("drive.encoder_resolution", model.data.encoder_resolution);
  set("drive.effort_per_volt", model.data.effort_per_volt());
  for (const CompensationParameter& parameter : compensation_parameters(model)) set(parameter.name, parameter.value);
  return firmware::axis_parameters<float>(values.axis(0)).compensation;
}

TachometerReading tachometer_reading(const sim::DriveDescription& model) {
  TachometerReading calibration;
  if (const auto* gain = model.find("tach_gain")) calibration.gain = gain->at("gain");
  if (const auto* offset = model.find("tach_offset")) calibration.offset = offset->at("offset");
  return calibration;
}

std::vector<std::string> uncompensated_effects(const sim::DriveDescription& model) {
  constexpr std::array<std::string_view, 10> kTakenUp{
      "inertia",  "viscous",   "coulomb",    "stribeck", "cogging", "presliding", "position_dependent_friction",
      "backlash", "tach_gain", "tach_offset"};
  std::vector<std::string> rest;
  for (const sim::EffectEntry& entry : model.effects)
    if (std::ranges::find(kTakenUp, entry.kind) == kTakenUp.end() && std::ranges::find(rest, entry.kind) == rest.end())
      rest.push_back(entry.kind);
  const std::size_t coggings = board_harmonics(model, "cogging").size();
  if (coggings > firmware::kCoggingHarmonics)
    rest.push_back(fmt::format("cogging beyond its {} largest harmonics", firmware::kCoggingHarmonics));
  return rest;
}

}  // namespace host
