// A dial gauge against the table, read by hand: what is lost between motor and table at a reversal.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace host {

/// In the order in which they were taken, the axis at rest each time. At least 4.
struct DialReadings {
  std::vector<double> x_mm;     ///< where the motor's encoder was
  std::vector<double> dial_mm;  ///< what the gauge read, counted as x_mm is
};

/// From a CSV file: lines that begin with `#`, a header, a row per reading. Columns: x_mm and dial_mm (also _um, _m).
/// A gauge that counts the other way is turned. Throws Failure(bad_input) with file, line, column and remedy.
DialReadings parse_dial_readings(std::string_view text, std::string_view name);

struct DialValue {
  double value = 0.0;
  std::array<double, 2> ci95{};
  double probability = 0.0;  ///< that it is not zero
};

struct DialStudy {
  DialValue lost_um;          ///< travel that the table does not follow at a reversal: gap and twice friction's bend
  DialValue lead_um_per_m;    ///< by which the table goes too far
  std::size_t reversals = 0;  ///< without one, nothing is known of lost_um
  double noise_um = 0.0;      ///< RMS, of readings beside both
};

/// Offset, lead error and a play operator by least squares; the play's width is profiled. Probabilities by Schwarz's
/// criterion over the four models with and without each (Kass and Raftery, JASA 90 (1995) 773-795, eq. (9)).
DialStudy study_dial(const DialReadings& readings);

/// Sentences: what is lost, what that says, what it does not.
std::string dial_words(const DialStudy& study);
/// {"format": "axis-dial/1", "lost_motion_um": {"value", "ci95", "probability"}, "lead_error_um_per_m": {…},
/// "reversals", "noise_um"}
nlohmann::json dial_json(const DialStudy& study);

}  // namespace host
