// Readings of a dial gauge on the table, taken by hand. They show the lost motion between motor and table at a
// reversal.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace host {

/// Readings in the order in which they were taken, each with the axis at rest. At least 4 are needed.
struct DialReadings {
  std::vector<double> x_mm;     ///< position of the motor's encoder
  std::vector<double> dial_mm;  ///< reading of the gauge, with the sign of x_mm
};

/// Reads a CSV file: lines that begin with `#`, a header, and a row per reading. Columns: x_mm and dial_mm (also _um,
/// _m). If the gauge counts in the other direction, its sign is inverted. Throws Failure(bad_input) with file, line,
/// column and remedy.
DialReadings parse_dial_readings(std::string_view text, std::string_view name);

struct DialValue {
  double value = 0.0;
  std::array<double, 2> ci95{};
  double probability = 0.0;  ///< probability that it is not zero
};

struct DialStudy {
  DialValue lost_um;          ///< lost motion at a reversal: the gap and twice the deflection by friction
  DialValue lead_um_per_m;    ///< excess travel of the table
  std::size_t reversals = 0;  ///< if 0, lost_um is unknown
  double noise_um = 0.0;      ///< RMS residual of the readings
};

/// Offset, lead error and a play operator by least squares; the width of the play comes from its profile likelihood.
/// Probabilities come from Schwarz's criterion over the four models with and without lead error and play (Kass and
/// Raftery, JASA 90 (1995) 773-795, eq. (9)).
DialStudy study_dial(const DialReadings& readings);

/// The lost motion, its meaning, and the limits of this conclusion, in sentences.
std::string dial_words(const DialStudy& study);
/// {"format": "axis-dial/1", "lost_motion_um": {"value", "ci95", "probability"}, "lead_error_um_per_m": {…},
/// "reversals", "noise_um"}
nlohmann::json dial_json(const DialStudy& study);

}  // namespace host
