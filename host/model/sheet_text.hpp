// Data sheets to fill in: every field with its unit and where to find its value in a manufacturer's data sheet.
#pragma once

#include <optional>
#include <string>

#include "sim/drive_description.hpp"

namespace host {

struct SheetValues {
  std::string name;
  sim::DriveKind kind = sim::DriveKind::rotary;
  bool by_current = true;                    ///< the logs contain the current; otherwise the command voltage
  std::optional<double> motor_constant{};    ///< Nm/A or N/A
  std::optional<double> lead_mm_per_turn{};  ///< lead of the screw or pinion; rotary drives only
  std::optional<double> encoder_step_mm{};   ///< step of the logged position
  std::optional<double> sample_period_s{};
};

/// A commented axis-model/1 file with the known values. Each needed value that is not known is a comment that describes
/// it.
std::string sheet_text(const SheetValues& values);

/// The keys that are needed but not known.
std::string sheet_gaps(const SheetValues& values);

/// The reference of the format in Markdown: every field, and examples.
std::string sheet_page();

}  // namespace host
