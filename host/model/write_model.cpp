#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "host/atomic_file.hpp"
#include "host/exit_codes.hpp"
#include "host/model/data_sheet_fields.hpp"
#include "host/model/effect_forms.hpp"
#include "host/model/model_file.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

/// The shortest text that reads back as the same number, and that TOML takes for a float.
std::string number(double value) {
  if (!std::isfinite(value))
    throw Failure(ExitCode::bad_input, "a model value is not a finite number: the fit that made it has failed");
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += {'\\', c};
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      out += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
    else
      out += c;
  }
  return out + '"';
}

void append_data_sheet(const sim::DataSheet& data, std::string& text) {
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "\n[drive]\nkind = \"{}\"\n", data.kind == sim::DriveKind::rotary ? "rotary" : "linear");
  std::string_view table;
  for (const DataSheetField& field : kDataSheetFields) {
    if (!field.belongs_to(data.kind) || field.presence == Presence::alternative_unit) continue;
    if (data.*field.value == 0.0 && !field.zero_allowed && field.presence == Presence::optional) continue;
    if (field.table != table) fmt::format_to(out, "\n[drive.{}]\n", field.table);
    table = field.table;
    fmt::format_to(out, "{} = {}\n", field.key, number(data.*field.value));
  }
  if (data.tach_noise_variance)
    fmt::format_to(out, "\n[drive.tach]\n{} = {}\n", tach_noise_key(data.kind), number(*data.tach_noise_variance));
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
  for (const sim::ParameterInfo& parameter : info->parameters) {
    const std::string id(parameter.id);
    if (!entry.has(id)) continue;
    fmt::format_to(out, "{} = {}\n", parameter.key(kind), number(entry.at(id)));
    // An interval that does not hold the value belongs to an earlier fit.
    if (const auto interval = entry.ci95.find(id);
        interval != entry.ci95.end() && holds(interval->second, entry.at(id)))
      fmt::format_to(out, "{}_ci95 = [{}, {}]\n", parameter.key(kind), number(interval->second[0]),
                     number(interval->second[1]));
  }
  if (!entry.from.empty()) fmt::format_to(out, "from = {}\n", quoted(entry.from));
}

}  // namespace

std::string format_model(const sim::DriveDescription& model) {
  std::string text = "format = \"axis-model/1\"\n";
  if (!model.name.empty()) text += fmt::format("name = {}\n", quoted(model.name));
  append_data_sheet(model.data, text);
  for (const sim::EffectEntry& entry : model.effects) append_effect(entry, model.data.kind, text);
  return text;
}

void write_model(const sim::DriveDescription& model, const std::string& path) {
  write_file_atomically(path, format_model(model));
}

}  // namespace host
