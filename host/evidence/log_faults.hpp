// Faults of logging that no physics explains: to be ruled out before any effect is suspected. What reading a record
// refuses anyway (dead or copied channels, gaps in time, speed against position in sign or unit) is not repeated here.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/record/log_fault.hpp"
#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Faults of a record that is adapted to its drive. `model` gives the data sheet and, with an inertia, what the drive
/// can do at most; without, signs and the command's size against the converter's range are judged all the same. Silent
/// where physics could explain a finding: a delay, a lag, a changed inertia, a limit of the amplifier.
std::vector<LogFault> log_faults(const Record& record, const sim::DriveDescription& model);

/// Of these, the channels that tell what another one tells. Wrong units and exchanged names may come of them.
std::vector<LogFault> copied_channels(const Record& record, const sim::DataSheet& data);

/// The list "log" of every command that reads records.
nlohmann::json log_faults_json(const std::vector<LogFault>& faults);

}  // namespace host
