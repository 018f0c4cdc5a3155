// Time at which a logged current acts, in samples. Loggers may hold or average the current, filter it, or sample it
// before the output.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Middle of the time over which a logged torque, force or current acts, in samples after its row, with its standard
/// deviation (0 if the time is known). The middle of a value held from its row to the next is half a sample after its
/// row.
struct EffortTiming {
  double samples = 0.5;
  double deviation = 0.0;

  friend bool operator==(const EffortTiming&, const EffortTiming&) = default;
};

/// Prior for a logged current: held from its row on like a command, with a standard deviation of a sample (loggers
/// average over the previous period, or log the current of one or two periods before).
inline constexpr EffortTiming kBelievedTiming{0.5, 1.0};

/// Largest deviation from the prior, in samples, that a logger can cause.
inline constexpr double kLargestTiming = 2.5;

/// Of a command, the time is known. For a current, it comes from the header of the record, `# effort_timing_samples:`
/// with `# effort_timing_deviation:` (0 if absent), otherwise from the prior.
EffortTiming effort_timing_of(const Record& record);

/// Estimates when the currents of the records act and writes the result to their headers, unless a header states it.
/// Fits the inverse model (inertia, friction by direction with a curve over the speed, a curve over the travel)
/// together with the time, on the samples of each record in which the axis slides, and combines the result with the
/// prior. Further effects of `model` are subtracted first; a missing effect may bias the time. Uses the prior alone if
/// a record does not determine the time, or if the result is a time that no logger can cause. All records come from one
/// logger, so they get the weighted mean; its standard deviation is widened to the scatter if that is larger. An
/// earlier estimate is replaced.
void settle_effort_timing(const std::vector<Record*>& records, const sim::DriveDescription& model);

/// Copies of the records with time offsets estimated for another model; empty if no offset was estimated.
std::vector<Record> timed_beside(const sim::DriveDescription& model, const std::vector<const Record*>& records);

/// The mean current that acts from each row to the next, A. Interpolates between rows; beyond the ends the first and
/// last row apply.
std::vector<double> acting_current(const Record& record);

/// A current as a drive holds it: the value of the next entry acts from the part `change` of a period after a row.
struct HeldCurrent {
  std::vector<double> i_A;  ///< the current that acts at each row, A; one more value than rows
  double change = 1.0;      ///< part of a period, above 0 and at most 1
};

/// The record's current shifted to the time at which it acts, without interpolation. Friction can stop an axis within a
/// part of a row. In this case the mean over the row, acting_current, would give a different motion from the two
/// successive currents.
HeldCurrent held_current(const Record& record);

/// Whether the time offset was estimated from each record, so that it contains no information about the drive.
bool timing_explains_delays(const std::vector<const Record*>& records);

/// {"samples", "ci95"} of all records together: the mean of the different times, weighted by their uncertainty. The
/// interval is widened to their scatter if that is larger.
nlohmann::json effort_timing_json(const std::vector<const Record*>& records);

}  // namespace host
