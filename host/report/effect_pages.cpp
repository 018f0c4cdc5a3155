#include "host/report/effect_pages.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

#include "host/model/effect_forms.hpp"
#include "host/model/model_file.hpp"
#include "sim/catalogue.hpp"
#include "sim/curve.hpp"

namespace host {

namespace {

struct StageName {
  sim::Stage stage;
  const char* name;
  const char* heading;
};

/// The stages in the order of the signal path.
constexpr std::array kStages = {
    StageName{sim::Stage::command, "command", "Command and current loop"},
    StageName{sim::Stage::motor, "motor", "Motor"},
    StageName{sim::Stage::load, "load", "Torques on the shaft"},
    StageName{sim::Stage::friction, "friction", "Friction"},
    StageName{sim::Stage::mechanics, "mechanics", "Masses and their connections"},
    StageName{sim::Stage::encoder, "encoder", "Encoder"},
    StageName{sim::Stage::tachometer, "tachometer", "Tachometer"},
    StageName{sim::Stage::table, "table", "Table, as a scale of its own sees it"},
};

const StageName& stage_name(sim::Stage stage) { return *std::ranges::find(kStages, stage, &StageName::stage); }

std::string_view first_sentence(std::string_view text) {
  const std::size_t end = text.find(". ");
  return end == std::string_view::npos ? text : text.substr(0, end);
}

/// An example value for a scale: the paper's x drive, and a linear drive of some hundred newtons.
double example_size(sim::Scale scale, sim::DriveKind kind) {
  const bool rotary = kind == sim::DriveKind::rotary;
  switch (scale) {
    case sim::Scale::unity:
      return 1.0;
    case sim::Scale::coulomb:
      return rotary ? 2.0 : 20.0;
    case sim::Scale::inertia:
      return rotary ? 0.008 : 95.0;
    case sim::Scale::viscous:
      return rotary ? 0.03 : 200.0;
    case sim::Scale::bristle_stiffness:
      return rotary ? 160.0 : 1e6;
    case sim::Scale::bristle_damping:
      return rotary ? 2.3 : 2e4;
    case sim::Scale::coulomb_per_travel:
      return rotary ? 0.007 : 70.0;
    case sim::Scale::stall_effort:
      return rotary ? 30.0 : 350.0;
    case sim::Scale::stall_current:
      return rotary ? 65.0 : 350.0;
    case sim::Scale::speed:
    case sim::Scale::millimetre:
      return rotary ? 1.0 : 0.001;
    case sim::Scale::converter_range:
      return 10.0;
    case sim::Scale::top_speed:
      return rotary ? 60.0 : 0.3;
    case sim::Scale::travel:
    case sim::Scale::position:
      return rotary ? 300.0 : 0.3;
    case sim::Scale::duration:
      return 60.0;
    case sim::Scale::first_stamp:
      return 0.0;
  }
  return 1.0;
}

double example_value(const sim::ParameterInfo& parameter, sim::DriveKind kind) {
  constexpr double kExamplePeriod = 10.0;  // period of a harmonic, in the scale of the parameter
  const double start = parameter.starts.empty() ? kExamplePeriod : parameter.starts.front();
  return std::clamp(start * example_size(parameter.scale, kind), parameter.lower, parameter.upper);
}

/// The parameters of the form with one value for both directions, if there is one; otherwise every parameter.
std::vector<const sim::ParameterInfo*> example_parameters(const sim::EffectInfo& info) {
  std::vector<std::string_view> replaced;
  for (const sim::ParameterInfo& parameter : info.parameters)
    for (const std::string_view id : ids_of_pair(parameter)) replaced.push_back(id);
  std::vector<const sim::ParameterInfo*> parameters;
  for (const sim::ParameterInfo& parameter : info.parameters) {
    const bool extra = parameter.optional && parameter.pair_of.empty() && parameter.id != "exponent";
    const bool one_of_a_pair = std::ranges::find(replaced, parameter.id) != replaced.end();
    if (!one_of_a_pair && !extra) parameters.push_back(&parameter);
  }
  return parameters;
}

void append_section(std::string& page, std::string_view heading, std::string_view text, const Terminal& terminal) {
  fmt::format_to(std::back_inserter(page), "\n{}\n{}", heading, wrapped(text, terminal.columns - 2, "  "));
}

void append_indented(std::string& page, std::string_view lines) {
  while (!lines.empty()) {
    const std::size_t end = lines.find('\n');
    fmt::format_to(std::back_inserter(page), "  {}\n", lines.substr(0, end));
    lines.remove_prefix(std::min(lines.size(), end == std::string_view::npos ? lines.size() : end + 1));
  }
}

void append_parameters(std::string& page, const sim::EffectInfo& info) {
  std::vector<std::array<std::string, 4>> rows = {{"rotary drive", "linear drive", "range", "meaning"}};
  for (const sim::ParameterInfo& parameter : info.parameters) {
    std::string meaning(parameter.doc);
    if (!parameter.pair_of.empty()) meaning += " (instead of one value per direction)";
    rows.push_back({std::string(parameter.rotary_key),
                    parameter.linear_key == parameter.rotary_key ? "the same" : std::string(parameter.linear_key),
                    fmt::format("{:g} to {:g}", parameter.lower, parameter.upper), meaning});
  }
  std::array<std::size_t, 3> widths{};
  for (const auto& row : rows)
    for (std::size_t column = 0; column < widths.size(); ++column)
      widths[column] = std::max(widths[column], row[column].size());
  page += "\nParameters\n";
  for (const auto& row : rows)
    fmt::format_to(std::back_inserter(page), "  {:<{}}  {:<{}}  {:<{}}  {}\n", row[0], widths[0], row[1], widths[1],
                   row[2], widths[2], row[3]);
}

nlohmann::json parameter_json(const sim::ParameterInfo& parameter) {
  return {{"id", parameter.id},
          {"doc", parameter.doc},
          {"rotary_key", parameter.rotary_key},
          {"linear_key", parameter.linear_key},
          {"lower", parameter.lower},
          {"upper", parameter.upper},
          {"optional", parameter.optional},
          {"stands_for", ids_of_pair(parameter)}};
}

nlohmann::json effect_json(const sim::EffectInfo& info) {
  nlohmann::json parameters = nlohmann::json::array();
  for (const sim::ParameterInfo& parameter : info.parameters) parameters.push_back(parameter_json(parameter));
  return {{"kind", info.kind},
          {"title", info.title},
          {"stage", stage_name(info.stage).name},
          {"base", info.base},
          {"may_repeat", may_repeat(info)},
          {"equation", info.equation},
          {"parameters", parameters},
          {"shows", info.shows},
          {"along", info.along},
          {"confused_with", info.confused_with},
          {"separate_by", info.separate_by},
          {"origin", info.origin},
          {"remedy", info.remedy},
          {"example",
           {{"rotary", effect_example_toml(info, sim::DriveKind::rotary)},
            {"linear", effect_example_toml(info, sim::DriveKind::linear)}}}};
}

nlohmann::json document(nlohmann::json effects) {
  return {{"format", "axis-effects/1"}, {"effects", std::move(effects)}};
}

}  // namespace

std::string effect_list(const Terminal& terminal) {
  std::size_t widest = 0;
  for (const sim::EffectInfo* info : sim::catalogue()) widest = std::max(widest, info->kind.size());
  std::string list;
  for (const StageName& stage : kStages) {
    fmt::format_to(std::back_inserter(list), "{}{}\n", list.empty() ? "" : "\n", stage.heading);
    for (const sim::EffectInfo* info : sim::catalogue()) {
      if (info->stage != stage.stage) continue;
      fmt::format_to(std::back_inserter(list), "  {:<{}}  {}{}\n", info->kind, widest, info->title,
                     info->base ? " (part of every model)" : "");
      const std::string indent(widest + 4, ' ');
      fmt::format_to(std::back_inserter(list), "{}", wrapped(first_sentence(info->shows), terminal.columns, indent));
    }
  }
  return list;
}

std::string effect_page(const sim::EffectInfo& info, const Terminal& terminal) {
  std::string page = fmt::format("{}: {}\n", info.kind, info.title);
  fmt::format_to(std::back_inserter(page), "Acts on: {}{}\n", stage_name(info.stage).name,
                 may_repeat(info) ? "; a model may hold several" : "");
  append_section(page, "Equation", info.equation, terminal);
  append_parameters(page, info);
  append_section(page, "How it shows in the residual", info.shows, terminal);
  if (!info.along.empty())
    append_section(page, "Coordinate that the residual depends on", fmt::format("{}", fmt::join(info.along, ", ")),
                   terminal);
  append_section(page, "Confused with", fmt::format("{}", fmt::join(info.confused_with, ", ")), terminal);
  append_section(page, "How to tell them apart", info.separate_by, terminal);
  append_section(page, "Origin", info.origin, terminal);
  append_section(page, "Remedy", info.remedy, terminal);
  page += "\nIn the model file of a rotary drive\n";
  append_indented(page, effect_example_toml(info, sim::DriveKind::rotary));
  page += "\nIn the model file of a linear drive\n";
  append_indented(page, effect_example_toml(info, sim::DriveKind::linear));
  return page;
}

sim::DriveDescription with_example(const sim::DriveDescription& model, const sim::EffectInfo& info) {
  return parse_model(format_model(model) + effect_example_toml(info, model.data.kind), std::string(info.kind));
}

std::string effect_example_toml(const sim::EffectInfo& info, sim::DriveKind kind) {
  std::string text = fmt::format("[[effect]]\nkind = \"{}\"\n", info.kind);
  if (info.curve) {
    fmt::format_to(std::back_inserter(text),
                   "over = \"speed\"  # or {}\n{} = [-1.0, 0.0, 1.0]\n{} = [-0.1, 0.0, 0.1]\n",
                   fmt::join(std::begin(sim::kCurveCoordinates) + 1, std::end(sim::kCurveCoordinates), ", "),
                   info.parameter("knot")->key(kind), info.parameter("value")->key(kind));
    return text;
  }
  for (const sim::ParameterInfo* parameter : example_parameters(info))
    fmt::format_to(std::back_inserter(text), "{} = {:.3g}\n", parameter->key(kind), example_value(*parameter, kind));
  return text;
}

nlohmann::json effects_json() {
  nlohmann::json effects = nlohmann::json::array();
  for (const sim::EffectInfo* info : sim::catalogue()) effects.push_back(effect_json(*info));
  return document(std::move(effects));
}

nlohmann::json effects_json(const sim::EffectInfo& info) {
  return document(nlohmann::json::array({effect_json(info)}));
}

}  // namespace host
