// Dates and times of day in logs.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace host {

struct ClockReading {
  std::optional<std::int64_t> day;  ///< days since 1970-01-01; empty if there is only a time of day
  double second = 0.0;              ///< seconds since midnight
  double last_digit = 1.0;          ///< weight of the finest digit, s
};

/// "2026-03-04 12:34:56.789", also with T as separator, a final Z, / in the date or a decimal comma; "04.03.2026";
/// "12:34:56". Empty for other text, and for dates with an ambiguous order of day and month (03/04/2026).
std::optional<ClockReading> parse_clock(std::string_view field);

}  // namespace host
