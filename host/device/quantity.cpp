#include "host/device/quantity.hpp"

#include <cstdlib>

namespace host {

std::optional<Quantity> parse_quantity(std::string_view text) {
  const std::string copy(text);
  char* end = nullptr;
  const double value = std::strtod(copy.c_str(), &end);
  if (end == copy.c_str()) return {};
  return Quantity{value, std::string(end)};
}

double length_factor(std::string_view unit, sim::DriveKind kind) {
  const double per_mm = kind == sim::DriveKind::rotary ? 1.0 : 1e-3;
  if (unit == "mm") return per_mm;
  if (unit == "m") return 1e3 * per_mm;
  if (unit == "um") return 1e-3 * per_mm;
  return 0.0;
}

}  // namespace host
