#include "host/model/sheet_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "host/known_by_current.hpp"
#include "host/model/data_sheet_fields.hpp"
#include "host/model/model_file.hpp"
#include "host/toml_text.hpp"

namespace host {

namespace {

std::string_view meaning_of(std::string_view key) {
  return std::ranges::find(kDataSheetFields, key, &DataSheetField::key)->meaning;
}

/// "key = value"; if there is no value, a comment to be completed.
std::string field(std::string_view key, const std::optional<double>& value = std::nullopt) {
  const std::string line = value ? fmt::format("{} = {:.12g}", key, *value) : fmt::format("# {} = ", key);
  return fmt::format("{:<44}# {}\n", line, meaning_of(key));
}

bool is_rotary(const SheetValues& values) { return values.kind == sim::DriveKind::rotary; }

std::optional<double> lead(const SheetValues& values) {
  if (!values.lead_mm_per_turn) return std::nullopt;
  return *values.lead_mm_per_turn / (2.0 * std::numbers::pi);
}

}  // namespace

std::string sheet_text(const SheetValues& values) {
  const bool rotary = is_rotary(values);
  std::string text = fmt::format(
      "# Data sheet of a drive (axis-model/1). Fill in each comment without a value: remove the # and write the\n"
      "# number. Fields that logs of the {} do not need are marked.\n"
      "format = \"axis-model/1\"\n"
      "name = {}\n"
      "\n"
      "[drive]\n"
      "{:<44}# a {} motor\n",
      values.by_current ? "current" : "command voltage", toml_string(values.name),
      rotary ? "kind = \"rotary\"" : "kind = \"linear\"", rotary ? "turning" : "linear");
  if (rotary) {
    text += field("torque_constant_Nm_per_A", values.motor_constant);
    // A log of the current needs no amplifier gain.
    if (!values.by_current) text += field("amplifier_gain_A_per_V");
    text += field("lead_mm_per_rad", lead(values));
  } else {
    text += field("force_constant_N_per_A", values.motor_constant);
    if (!values.by_current) text += field("force_constant_N_per_V");
  }
  text += field("sample_period_s", values.sample_period_s);
  text += "\n[drive.encoder]\n";
  const double to_unit = rotary ? 1.0 : 1e-3;
  const std::optional<double> step =
      values.encoder_step_mm ? std::optional(*values.encoder_step_mm * to_unit) : std::nullopt;
  text += field(rotary ? "resolution_mm" : "resolution_m", step);
  if (!values.by_current) text += "\n[drive.dac]\n" + field("resolution_V") + field("limit_V");
  return text;
}

std::string sheet_gaps(const SheetValues& values) {
  std::string gaps;
  const auto need = [&](bool missing, std::string_view key) {
    if (missing) gaps += fmt::format("{}{}", gaps.empty() ? "" : ", ", key);
  };
  const bool rotary = is_rotary(values);
  need(!values.motor_constant, rotary ? "torque_constant_Nm_per_A" : "force_constant_N_per_A");
  need(!values.by_current, rotary ? "amplifier_gain_A_per_V" : "force_constant_N_per_V");
  need(rotary && !values.lead_mm_per_turn, "lead_mm_per_rad");
  need(!values.sample_period_s, "sample_period_s");
  return gaps;
}

namespace {

struct SheetExample {
  std::string_view title;
  sim::DriveDescription drive;
};

/// Typical drives: a ball screw with 10 mm per turn, and a linear motor with a scale of 1 um.
std::vector<SheetExample> examples() {
  sim::DriveDescription screw, motor;
  screw.name = std::string("x");
  screw.data.amplifier_gain_A_per_V = 2.5;
  screw.data.torque_constant_Nm_per_A = 0.48;
  screw.data.lead = 1.5915;
  screw.data.dac_resolution_V = motor.data.dac_resolution_V = 3.05e-4;
  screw.data.encoder_resolution = 1e-3;
  screw.data.tach_noise_variance = 0.05;
  motor.name = std::string("z");
  motor.data.kind = sim::DriveKind::linear;
  motor.data.force_constant_N_per_V = 60.0;
  motor.data.sample_period_s = 5e-4;
  motor.data.encoder_resolution = 1e-6;
  sim::DriveDescription screw_by_current = screw, motor_by_current = motor;
  motor_by_current.data.torque_constant_Nm_per_A = 24.0;
  for (sim::DriveDescription* drive : {&screw_by_current, &motor_by_current}) {
    drive->data.tach_noise_variance.reset();
    know_by_current(drive->data);
  }
  return {{"A ball screw, logs of the command voltage, a tachometer", screw},
          {"The same, logs of the current", screw_by_current},
          {"A linear motor, logs of the command voltage", motor},
          {"The same, logs of the current", motor_by_current}};
}

std::string_view need_of(const DataSheetField& field) {
  switch (field.presence) {
    case Presence::required:
      return "always";
    case Presence::of_volts:
      return field.table.empty() ? "for logs of the voltage" : "no";
    case Presence::optional:
    case Presence::alternative_unit:
      break;
  }
  return field.table.empty() ? "for logs of the current" : "no";
}

std::string_view kind_of(const DataSheetField& field) {
  return !field.only ? "both" : *field.only == sim::DriveKind::rotary ? "rotary" : "linear";
}

}  // namespace

std::string sheet_page() {
  std::string page =
      "# Data sheets and models\n"
      "\n"
      "Written by `axistool sheet --markdown` from `data_sheet_fields.hpp`.\n"
      "\n"
      "A data sheet is a model file (TOML, `axis-model/1`) without effects: the manufacturer's data of a drive.\n"
      "`axistool sheet` writes one with comments to fill in; `identify` adds the effects. An error lists all missing "
      "fields\n"
      "at once.\n"
      "\n"
      "The file begins with `format = \"axis-model/1\"` and `name`; `[drive]` begins with `kind`, \"rotary\" or "
      "\"linear\".\n"
      "\n"
      "| Field | In | Drive | Needed | What |\n"
      "|---|---|---|---|---|\n";
  for (const DataSheetField& field : kDataSheetFields)
    page += fmt::format("| `{}` | `[drive{}{}]` | {} | {} | {} |\n", field.key, field.table.empty() ? "" : ".",
                        field.table, kind_of(field), need_of(field), field.meaning);
  for (const sim::DriveKind kind : {sim::DriveKind::rotary, sim::DriveKind::linear})
    page += fmt::format("| `{}` | `[drive.tach]` | {} | with this table | {}: 0 or more; identify measures it |\n",
                        tach_noise_key(kind), kind == sim::DriveKind::rotary ? "rotary" : "linear",
                        "variance of the tachometer's noise");
  for (const SheetExample& example : examples())
    page += fmt::format("\n## {}\n\n```toml\n{}```\n", example.title, format_model(example.drive));
  return page;
}

}  // namespace host
