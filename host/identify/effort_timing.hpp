// Time at which a logged current acts, in parts of a sample: loggers hold, average, filter, or sample before the
// output.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Middle of the time over which a logged torque, force or current acts, in samples after its row, with its standard
/// deviation; 0 if it is known. A value held from its row to the next acts half a sample after it.
struct EffortTiming {
  double samples = 0.5;
  double deviation = 0.0;

  friend bool operator==(const EffortTiming&, const EffortTiming&) = default;
};

/// Prior for a logged current: held from its row on, like a command, within about a sample (loggers average over the
/// previous period, or log the current of one or two periods ago).
inline constexpr EffortTiming kBelievedTiming{0.5, 1.0};

/// Largest deviation from the prior, in samples, that a logger can cause.
inline constexpr double kLargestTiming = 2.5;

/// Of a command: known. Of a current: that of the record's header, `# effort_timing_samples:` with `#
/// effort_timing_deviation:` (0 if absent); otherwise the prior.
EffortTiming effort_timing_of(const Record& record);

/// Estimates when the records' currents act and writes that to their headers, unless a header states it. Fits the
/// inverse model (inertia, friction by direction with a curve over the speed, a curve over the travel) together with
/// the time, on the samples that slide of each record, and combines the result with the prior. Further effects of
/// `model` are subtracted first; a missing effect may bias the time. Uses the prior alone if a record does not
/// determine the time, or gives one that no logger can cause. One logger wrote all records: they share the weighted
/// mean, with a deviation widened to their scatter if that is larger. A time that was estimated before is estimated
/// again.
void settle_effort_timing(const std::vector<Record*>& records, const sim::DriveDescription& model);

/// Copies of the records with their times settled beside another model; empty if no time was estimated.
std::vector<Record> timed_beside(const sim::DriveDescription& model, const std::vector<const Record*>& records);

/// The current that acts, on average, from each row to the next, A. Interpolates between rows; beyond the ends the
/// first and last row apply.
std::vector<double> acting_current(const Record& record);

/// A current as a drive holds it: from `change` of a period after a row on, that of the next entry acts.
struct HeldCurrent {
  std::vector<double> i_A;  ///< the one that acts at each row, A; one more than the record has rows
  double change = 1.0;      ///< of a period, above 0 and at most 1
};

/// The record's current moved to where it acts, without interpolation. Friction stops an axis within a part of a row:
/// there the mean over the row, acting_current, would give another motion than the two currents one after the other.
HeldCurrent held_current(const Record& record);

/// Whether the timing was estimated from each record, so that it contains no information on the drive.
bool timing_explains_delays(const std::vector<const Record*>& records);

/// {"samples", "ci95"} of all records together: the mean of the times that differ, weighted by their uncertainty; the
/// interval is widened to their scatter if that is larger.
nlohmann::json effort_timing_json(const std::vector<const Record*>& records);

}  // namespace host
