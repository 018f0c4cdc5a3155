// Faults of logging that no physics explains. They are found before the search for effects. Faults with which a record
// is not read at all (dead or copied channels, gaps in time, speed and position with different sign or unit) are not
// repeated here.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/record/log_fault.hpp"
#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Faults of a record that is adapted to its drive. `model` gives the data sheet and, if it has an inertia, the limits
/// of the drive. Without an inertia, only signs and the size of the command relative to the converter's range are
/// checked. A deviation that physics could explain is not reported: a delay, a lag, a changed inertia, a limit of the
/// amplifier.
std::vector<LogFault> log_faults(const Record& record, const sim::DriveDescription& model);

/// The copied channels among the faults. They may be the cause of apparent wrong units and exchanged names.
std::vector<LogFault> copied_channels(const Record& record, const sim::DataSheet& data);

/// The list "log" in the JSON output of every command that reads records.
nlohmann::json log_faults_json(const std::vector<LogFault>& faults);

}  // namespace host
