// Readings of a dial gauge on the table, taken by hand: lost motion between motor and table at a reversal.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace host {

/// Readings in the order in which they were taken, each with the axis at rest. At least 4.
struct DialReadings {
  std::vector<double> x_mm;     ///< position of the motor's encoder
  std::vector<double> dial_mm;  ///< reading of the gauge, with the sign of x_mm
};

/// From a CSV file: lines that begin with `#`, a header, a row per reading. Columns: x_mm and dial_mm (also _um, _m).
/// The sign of a gauge that counts in the other direction is inverted. Throws Failure(bad_input) with file, line,
/// column and remedy.
DialReadings parse_dial_readings(std::string_view text, std::string_view name);

struct DialValue {
  double value = 0.0;
  std::array<double, 2> ci95{};
  double probability = 0.0;  ///< probability that it is not zero
};

struct DialStudy {
  DialValue lost_um;          ///< travel that the table does not follow at a reversal: gap and twice friction's bend
  DialValue lead_um_per_m;    ///< excess travel of the table
  std::size_t reversals = 0;  ///< without a reversal, lost_um is unknown
  double noise_um = 0.0;      ///< RMS of the readings' residual
};

/// Offset, lead error and a play operator by least squares; the play's width is profiled. Probabilities by Schwarz's
/// criterion over the four models with and without each (Kass and Raftery, JASA 90 (1995) 773-795, eq. (9)).
DialStudy study_dial(const DialReadings& readings);

/// Sentences: the lost motion, its meaning, and the limits of this conclusion.
std::string dial_words(const DialStudy& study);
/// {"format": "axis-dial/1", "lost_motion_um": {"value", "ci95", "probability"}, "lead_error_um_per_m": {…},
/// "reversals", "noise_um"}
nlohmann::json dial_json(const DialStudy& study);

}  // namespace host
