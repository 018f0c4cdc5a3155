// Dates and times of day in logs.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace host {

struct ClockReading {
  std::optional<std::int64_t> day;  ///< since 1970-01-01; empty: a time of day alone
  double second = 0.0;              ///< of the day
  double last_digit = 1.0;          ///< weight of the finest digit, s
};

/// "2026-03-04 12:34:56.789", also with T between, Z behind, / or decimal comma; "04.03.2026"; "12:34:56". Empty for
/// other text, and for dates with an ambiguous order of day and month (03/04/2026).
std::optional<ClockReading> parse_clock(std::string_view field);

}  // namespace host
