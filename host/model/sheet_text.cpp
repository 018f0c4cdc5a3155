#include "host/model/sheet_text.hpp"

#include <fmt/format.h>

#include <numbers>

namespace host {

namespace {

/// "key = value", or the same as a comment with nothing behind it.
std::string field(std::string_view key, const std::optional<double>& value, std::string_view meaning) {
  const std::string line = value ? fmt::format("{} = {:#.12g}", key, *value) : fmt::format("# {} = ", key);
  return fmt::format("{:<44}# {}\n", line, meaning);
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
      "# Data sheet of a drive (axis-model/1). Fill in what stands as a comment without a value: take the # away and\n"
      "# write the number. What is not needed for logs of the {} is marked so.\n"
      "format = \"axis-model/1\"\nname = \"{}\"\n\n[drive]\n{:<44}# a {} motor\n",
      values.by_current ? "current" : "command voltage", values.name,
      rotary ? "kind = \"rotary\"" : "kind = \"linear\"", rotary ? "turning" : "linear");
  if (rotary) {
    text += field("torque_constant_Nm_per_A", values.motor_constant,
                  "Kt, Nm/A: the motor's data sheet; per A rms where the log is in A rms");
    // A log of the current holds what the motor got: the amplifier's gain does not enter.
    if (!values.by_current)
      text += field("amplifier_gain_A_per_V", std::nullopt,
                    "Ka, A/V: the amplifier's current limit over its command range");
    text += field("lead_mm_per_rad", lead(values), "mm/rad: travel of a motor turn over 2 pi (10 mm a turn: 1.5915)");
  } else {
    text += field("force_constant_N_per_A", values.motor_constant, "N/A: the motor's data sheet");
    if (!values.by_current) text += field("force_constant_N_per_V", std::nullopt, "N/V: N/A times the amplifier's A/V");
  }
  text += field("sample_period_s", values.sample_period_s, "s: the controller's period, that of the log");
  text += "\n[drive.encoder]\n";
  const double to_unit = rotary ? 1.0 : 1e-3;
  const std::optional<double> step =
      values.encoder_step_mm ? std::optional(*values.encoder_step_mm * to_unit) : std::nullopt;
  text += field(rotary ? "resolution_mm" : "resolution_m", step,
                rotary ? "mm: travel of one count (10 mm a turn, 65536 counts: 1.526e-4)" : "m: travel of one count");
  if (!values.by_current) {
    text += "\n[drive.dac]\n";
    text += field("resolution_V", std::nullopt, "V: one step of the command's converter (20 V, 16 bit: 3.05e-4)");
    text += field("limit_V", std::nullopt, "V: its range is -limit to +limit, 10 if absent");
  }
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

}  // namespace host
