// When a logged current acts, in parts of a sample: loggers hold, average, filter or sample before the output.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// The middle of the time over which a logged effort acts, in samples after its row, with its standard deviation; 0
/// where it is known. What is held from its row to the next acts half a sample after it.
struct EffortTiming {
  double samples = 0.5;
  double deviation = 0.0;
};

/// Prior for a logged current: it is held from its row on, like a command, within about a sample (loggers average over
/// the period before, or take the current of one or two periods ago).
inline constexpr EffortTiming kBelievedTiming{0.5, 1.0};

/// Largest deviation from the prior, in samples, that a logger explains.
inline constexpr double kLargestTiming = 2.5;

/// Of a command: known. Of a current: what the record's header says, `# effort_timing_samples:` with
/// `# effort_timing_deviation:` (0 where it is absent); else that it is held, as nobody has looked yet.
EffortTiming effort_timing_of(const Record& record);

/// Finds when the record's current acts and writes that to its header, where it does not stand already; from the
/// inverse model: inertia, friction by direction with a bend over the speed, a curve over the travel and the instant
/// are found together, on the samples that slide, and combined with the belief. The belief alone where the record does
/// not tell, or tells of an instant that no logger's habits explain.
void settle_effort_timing(Record& record, const sim::DataSheet& data);

/// The current that acts, on average, from each row to the next one, A. Interpolates between rows; beyond the ends the
/// first and last row hold.
std::vector<double> acting_current(const Record& record);

/// Whether the timing was estimated from each record, so that it gives no information on the drive.
bool timing_explains_delays(const std::vector<const Record*>& records);

/// {"samples", "ci95"} of all records together: weighed by what each tells; as uncertain as they scatter where that is
/// more.
nlohmann::json effort_timing_json(const std::vector<const Record*>& records);

}  // namespace host
