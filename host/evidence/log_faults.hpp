// Faults of logging that no physics explains; they are excluded before the search for effects. Faults that reading a
// record refuses (dead or copied channels, gaps in time, speed against position in sign or unit) are not repeated here.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/record/log_fault.hpp"
#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Faults of a record that is adapted to its drive. `model` gives the data sheet and, with an inertia, the drive's
/// limits; without an inertia, signs and the command's size against the converter's range are still checked. Reports
/// nothing that physics could explain: a delay, a lag, a changed inertia, a limit of the amplifier.
std::vector<LogFault> log_faults(const Record& record, const sim::DriveDescription& model);

/// The copied channels among these faults. Wrong units and exchanged names may be their consequences.
std::vector<LogFault> copied_channels(const Record& record, const sim::DataSheet& data);

/// The list "log" in the JSON output of every command that reads records.
nlohmann::json log_faults_json(const std::vector<LogFault>& faults);

}  // namespace host
