// Numbers with a unit behind them, as people write them on a command line.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "sim/drive_description.hpp"

namespace host {

struct Quantity {
  double value = 0.0;
  std::string unit;  ///< all that stands behind the number; may be empty
};

/// "20um", "0.5V", "12". Empty where no number begins the text.
std::optional<Quantity> parse_quantity(std::string_view text);

/// What turns a length in mm, m or um into the drive's own unit (rotary: mm; linear: m); 0 for any other unit.
double length_factor(std::string_view unit, sim::DriveKind kind);

}  // namespace host
