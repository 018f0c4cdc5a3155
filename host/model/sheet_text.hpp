// Data sheets to be filled in: every field with its unit, and the place of its value in a manufacturer's data sheet.
#pragma once

#include <optional>
#include <string>

#include "sim/drive_description.hpp"

namespace host {

struct SheetValues {
  std::string name;
  sim::DriveKind kind = sim::DriveKind::rotary;
  bool by_current = true;                    ///< the logs hold the current; else the command voltage
  std::optional<double> motor_constant{};    ///< Nm/A or N/A
  std::optional<double> lead_mm_per_turn{};  ///< of the screw or pinion; rotary only
  std::optional<double> encoder_step_mm{};   ///< of the position as logged
  std::optional<double> sample_period_s{};
};

/// A commented axis-model/1 file with the known values; each needed value that is not known is a comment that describes
/// it.
std::string sheet_text(const SheetValues& values);

/// The keys that are needed and not yet known.
std::string sheet_gaps(const SheetValues& values);

/// The reference of the format, in Markdown: every field, and an example of each kind.
std::string sheet_page();

}  // namespace host
