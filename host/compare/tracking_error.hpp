// Tracking error of a record without command or current, from position (or speed) and reference: its sources in the
// motion, without physics.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/evidence/period_search.hpp"
#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// A share of the tracking error that follows a quantity of the reference.
struct TrackingPart {
  std::string with;  ///< "constant", "speed", "direction", "acceleration"
  double coefficient = 0.0;
  std::string unit;    ///< of the coefficient
  double share = 0.0;  ///< part of the squared error that it explains, 0..1, in this order
};

/// Reference minus measurement.
struct TrackingError {
  std::string path;
  std::string channel;  ///< x_mm, x_m, w_rad_s or v_m_s
  double rms = 0.0, largest = 0.0, largest_at_s = 0.0;
  std::vector<TrackingPart> parts;
  std::vector<PeriodPeak> periods;  ///< of the remaining error along the travel; only if a position was recorded
};

/// Whether a record has a reference and its measurement, but no torque, force or command.
bool has_reference_only(const Record& record);

/// The records of these files, if none of them has a command, torque or force; otherwise none. `data`: of their drive.
std::vector<Record> tracking_records(const std::vector<std::string>& paths, const sim::DataSheet& data);

/// Throws Failure(bad_input) where has_reference_only() does not hold.
TrackingError tracking_error(const Record& record);

std::string tracking_text(const std::vector<TrackingError>& errors);
nlohmann::json tracking_json(const std::vector<TrackingError>& errors);  ///< "axis-tracking/1"

}  // namespace host
