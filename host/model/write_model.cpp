#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "host/atomic_file.hpp"
#include "host/exit_codes.hpp"
#include "host/known_by_current.hpp"
#include "host/model/data_sheet_fields.hpp"
#include "host/model/effect_forms.hpp"
#include "host/model/model_file.hpp"
#include "host/statistics.hpp"
#include "host/toml_text.hpp"
#include "sim/catalogue.hpp"
#include "sim/curve.hpp"
#include "sim/harmonic.hpp"

namespace host {

namespace {

std::string finite_number(double value) {
  if (!std::isfinite(value))
    throw Failure(ExitCode::bad_input, "a model value is not a finite number: the fit that made it has failed");
  return toml_number(value);
}

void append_data_sheet(const sim::DataSheet& data, std::string& text) {
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "\n[drive]\nkind = \"{}\"\n", data.kind == sim::DriveKind::rotary ? "rotary" : "linear");
  std::string_view table;
  for (const DataSheetField& field : kDataSheetFields) {
    if (!field.belongs_to(data.kind) || field.presence == Presence::alternative_unit) continue;
    if (field.presence == Presence::of_volts && is_known_by_current(data)) continue;
    if (field.table == "load_encoder" && !data.has_load_encoder()) continue;
    if (data.*field.value == 0.0 && !field.zero_allowed && field.presence == Presence::optional) continue;
    if (field.table != table) fmt::format_to(out, "\n[drive.{}]\n", field.table);
    table = field.table;
    fmt::format_to(out, "{} = {}\n", field.key, finite_number(data.*field.value));
  }
  if (data.tach_noise_variance)
    fmt::format_to(out, "\n[drive.tach]\n{} = {}\n", tach_noise_key(data.kind),
                   finite_number(*data.tach_noise_variance));
}

/// The value of a parameter and its additional fields: "J_kg_m2 = 0.1", "J_kg_m2_ci95 = [0.09, 0.11]", …
std::vector<std::string> fields_of(const sim::EffectEntry& entry, const std::string& id, std::string_view key) {
  std::vector<std::string> fields = {fmt::format("{} = {}", key, finite_number(entry.at(id)))};
  // An interval that does not contain the value is from an earlier fit.
  if (const auto interval = entry.ci95.find(id); interval != entry.ci95.end() && holds(interval->second, entry.at(id)))
    fields.push_back(
        fmt::format("{}_ci95 = [{}, {}]", key, finite_number(interval->second[0]), finite_number(interval->second[1])));
  if (entry.held.contains(id)) fields.push_back(fmt::format("{}_held = true", key));
  if (const auto belief = entry.believed.find(id); belief != entry.believed.end()) {
    fields.push_back(fmt::format("{}_sd = {}", key, finite_number(belief->second.deviation)));
    if (belief->second.value != entry.at(id))
      fields.push_back(fmt::format("{}_given = {}", key, finite_number(belief->second.value)));
  }
  return fields;
}

/// `harmonics = [ … ]`, with one order per line.
void append_harmonics(const sim::EffectEntry& entry, const sim::EffectInfo& info, sim::DriveKind kind,
                      std::string& text) {
  text += "harmonics = [\n";
  for (const sim::HarmonicTerm& term : sim::harmonics_of(entry)) {
    std::vector<std::string> fields = {fmt::format("order = {}", term.order)};
    for (const char* family : {"cosine", "sine"}) {
      const std::string id = sim::harmonic_id(family, term.order);
      if (!entry.has(id)) continue;
      const std::vector<std::string> own = fields_of(entry, id, info.parameter(family)->key(kind));
      fields.insert(fields.end(), own.begin(), own.end());
    }
    fmt::format_to(std::back_inserter(text), "  {{ {} }},\n", fmt::join(fields, ", "));
  }
  text += "]\n";
}

void append_curve(const sim::EffectEntry& entry, const sim::EffectInfo& info, sim::DriveKind kind, std::string& text) {
  const sim::Curve curve(entry);
  const auto list = [](const std::vector<double>& values) {
    std::vector<std::string> texts;
    for (const double value : values) texts.push_back(finite_number(value));
    return fmt::format("[{}]", fmt::join(texts, ", "));
  };
  std::vector<double> deviations;
  for (std::size_t n = 0; n < curve.values().size(); ++n)
    if (const auto interval = entry.ci95.find(sim::numbered_id("value", static_cast<double>(n)));
        interval != entry.ci95.end())
      deviations.push_back(0.5 * (interval->second[1] - interval->second[0]) / kNormal95);
  fmt::format_to(std::back_inserter(text), "over = {}\n{} = {}\n{} = {}\n", toml_string(entry.over),
                 info.parameter("knot")->key(kind), list(curve.knots()), info.parameter("value")->key(kind),
                 list(curve.values()));
  if (deviations.size() == curve.values().size())
    fmt::format_to(std::back_inserter(text), "{} = {}\n", curve_deviation_key(kind), list(deviations));
}

void append_effect(const sim::EffectEntry& entry, sim::DriveKind kind, std::string& text) {
  const sim::EffectInfo* info = sim::find_effect(entry.kind);
  if (info == nullptr)
    throw Failure(ExitCode::bad_input, fmt::format("effect '{}' is not in the catalogue", entry.kind));
  for (const auto& [id, value] : entry.parameters)
    if (info->parameter(id) == nullptr)
      throw Failure(ExitCode::bad_input, fmt::format("effect {} has no parameter '{}'", entry.kind, id));
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "\n[[effect]]\nkind = \"{}\"\n", entry.kind);
  if (info->curve) append_curve(entry, *info, kind, text);
  const bool in_a_list = std::ranges::any_of(
      entry.parameters, [](const auto& parameter) { return sim::number_of(parameter.first).has_value(); });
  for (const sim::ParameterInfo& parameter : info->parameters) {
    const std::string id(parameter.id);
    const bool listed = info->periodic && in_a_list && (id == "cosine" || id == "sine");
    if (!entry.has(id) || listed || info->curve) continue;
    for (const std::string& field : fields_of(entry, id, parameter.key(kind))) fmt::format_to(out, "{}\n", field);
  }
  if (info->periodic && in_a_list) append_harmonics(entry, *info, kind, text);
  if (!entry.from.empty()) fmt::format_to(out, "from = {}\n", toml_string(entry.from));
}

}  // namespace

std::string format_model(const sim::DriveDescription& model) {
  std::string text = "format = \"axis-model/1\"\n";
  if (!model.name.empty()) text += fmt::format("name = {}\n", toml_string(model.name));
  append_data_sheet(model.data, text);
  for (const sim::EffectEntry& entry : model.effects) append_effect(entry, model.data.kind, text);
  return text;
}

void write_model(const sim::DriveDescription& model, const std::string& path) {
  write_file_atomically(path, format_model(model));
}

}  // namespace host
