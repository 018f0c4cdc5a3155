#include "host/model/known_parameters.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <optional>
#include <utility>

#include "host/exit_codes.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

/// Entry and id of every parameter under that key.
std::vector<std::pair<sim::EffectEntry*, std::string>> found(sim::DriveDescription& model, const std::string& name,
                                                             std::string_view option) {
  const std::size_t dot = name.find('.');
  const std::string kind = dot == std::string::npos ? "" : name.substr(0, dot);
  const std::string key = dot == std::string::npos ? name : name.substr(dot + 1);
  std::vector<std::pair<sim::EffectEntry*, std::string>> all;
  std::vector<std::string> keys;
  for (sim::EffectEntry& entry : model.effects) {
    if (!kind.empty() && entry.kind != kind) continue;
    for (const auto& [id, value] : entry.parameters) {
      keys.emplace_back(sim::find_effect(entry.kind)->parameter(id)->key(model.data.kind));
      if (keys.back() == key) all.emplace_back(&entry, id);
    }
  }
  if (all.empty())
    throw Failure(ExitCode::usage, fmt::format("{} {}: the model has no such parameter; it has {}", option, name,
                                               fmt::join(keys, ", ")));
  return all;
}

std::optional<double> number_in(std::string_view text) {
  double number = 0.0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && rest == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

}  // namespace

sim::DriveDescription with_knowledge(sim::DriveDescription model, const std::vector<std::string>& held,
                                     const std::vector<std::string>& believed) {
  for (const std::string& name : held)
    for (const auto& [entry, id] : found(model, name, "--hold")) entry->held.insert(id);
  for (const std::string& text : believed) {
    const std::size_t sign = text.find('=');
    const auto deviation =
        sign == std::string::npos ? std::nullopt : number_in(std::string_view(text).substr(sign + 1));
    if (!deviation || !(*deviation > 0.0))
      throw Failure(ExitCode::usage, fmt::format("--prior {}: write KEY=DEVIATION, e.g. J_kg_m2=1e-4", text));
    for (const auto& [entry, id] : found(model, text.substr(0, sign), "--prior"))
      entry->believed[id] = {entry->at(id), *deviation};
  }
  return model;
}

}  // namespace host
