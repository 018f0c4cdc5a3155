#include "host/model/known_parameters.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <utility>

#include "host/exit_codes.hpp"
#include "host/number.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

/// Entry and id of every parameter with that key.
std::vector<std::pair<sim::EffectEntry*, std::string>> found(sim::DriveDescription& model, const std::string& name,
                                                             std::string_view option) {
  const std::size_t dot = name.find('.');
  const std::string kind = dot == std::string::npos ? "" : name.substr(0, dot);
  const std::string key = dot == std::string::npos ? name : name.substr(dot + 1);
  std::vector<std::pair<sim::EffectEntry*, std::string>> all;
  std::vector<std::string> keys;
  for (sim::EffectEntry& entry : model.effects)
    for (const auto& [id, value] : entry.parameters) {
      const std::string_view own = sim::find_effect(entry.kind)->parameter(id)->key(model.data.kind);
      keys.push_back(fmt::format("{}.{}", entry.kind, own));
      if (!kind.empty() && entry.kind != kind) continue;
      if (own == key || (!kind.empty() && id == key)) all.emplace_back(&entry, id);
    }
  if (all.empty())
    throw Failure(ExitCode::usage, fmt::format("{} {}: the model has no such parameter; it has {}", option, name,
                                               fmt::join(keys, ", ")));
  return all;
}

}  // namespace

sim::DriveDescription with_knowledge(sim::DriveDescription model, const std::vector<std::string>& held,
                                     const std::vector<std::string>& believed) {
  for (const std::string& name : held)
    for (const auto& [entry, id] : found(model, name, "--hold")) entry->held.insert(id);
  for (const std::string& text : believed) {
    const std::optional<NamedNumber> prior = parse_named_number(text);
    if (!prior) throw Failure(ExitCode::usage, fmt::format("--prior {}: write KEY=DEVIATION, e.g. J_kg_m2=1e-4", text));
    for (const auto& [entry, id] : found(model, prior->name, "--prior"))
      entry->believed[id] = {entry->at(id), prior->value};
  }
  return model;
}

sim::DriveDescription with_values(sim::DriveDescription model, const std::vector<std::string>& values) {
  for (const std::string& text : values) {
    const std::size_t equals = text.find('=');
    const std::optional<double> value =
        equals == std::string::npos ? std::nullopt : parse_number(std::string_view(text).substr(equals + 1));
    if (!value) throw Failure(ExitCode::usage, fmt::format("{}: write NAME=VALUE, e.g. cogging.cosine_Nm=0.2", text));
    for (const auto& [entry, id] : found(model, text.substr(0, equals), "value of")) {
      const sim::ParameterInfo& info = *sim::find_effect(entry->kind)->parameter(id);
      if (!(*value >= info.lower && *value <= info.upper))
        throw Failure(ExitCode::usage, fmt::format("{}: outside {:g} to {:g}", text, info.lower, info.upper));
      entry->parameters[id] = *value;
      entry->ci95.erase(id);
    }
  }
  return model;
}

}  // namespace host
