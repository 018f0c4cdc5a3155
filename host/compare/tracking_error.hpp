// Tracking error of a record without command or current, from position (or speed) and reference. Describes it by
// quantities of the motion, without physics.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/evidence/period_search.hpp"
#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// A share of the tracking error that is proportional to a quantity of the reference.
struct TrackingPart {
  std::string with;  ///< "constant", "speed", "direction", "acceleration"
  double coefficient = 0.0;
  std::string unit;    ///< unit of the coefficient
  double share = 0.0;  ///< part of the squared error that it explains beyond the earlier ones, 0..1
};

/// The tracking error is reference minus measurement.
struct TrackingError {
  std::string path;
  std::string channel;  ///< x_mm, x_m, w_rad_s or v_m_s
  double rms = 0.0, largest = 0.0, largest_at_s = 0.0;
  std::vector<TrackingPart> parts;
  std::vector<PeriodPeak> periods;  ///< periods of the remaining error along the travel; needs a position
};

/// Whether a record has a reference and its measurement, but no torque, force or command.
bool has_reference_only(const Record& record);

/// The records of these files, if none of them has a command, torque or force; otherwise empty. `data`: of their drive.
std::vector<Record> tracking_records(const std::vector<std::string>& paths, const sim::DataSheet& data);

/// Throws Failure(bad_input) if has_reference_only() is false.
TrackingError tracking_error(const Record& record);

std::string tracking_text(const std::vector<TrackingError>& errors);
nlohmann::json tracking_json(const std::vector<TrackingError>& errors);  ///< "axis-tracking/1"

}  // namespace host
