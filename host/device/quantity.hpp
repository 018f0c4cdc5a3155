// Parses numbers with a unit, for the command line.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "sim/drive_description.hpp"

namespace host {

struct Quantity {
  double value = 0.0;
  std::string unit;  ///< all text after the number; may be empty
};

/// "20um", "0.5V", "12". Empty if the text does not begin with a number.
std::optional<Quantity> parse_quantity(std::string_view text);

/// Factor from mm, m or um to the drive's own unit (rotary: mm; linear: m); 0 for any other unit.
double length_factor(std::string_view unit, sim::DriveKind kind);

}  // namespace host
