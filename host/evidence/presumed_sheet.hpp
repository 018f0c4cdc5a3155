// A provisional data sheet, from a record alone.
#pragma once

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// The kind of drive, and the travel per angle from position and speed (1 if one of them is missing). This suffices for
/// the gate to check other records and channels, except torque or force.
sim::DriveDescription presumed_sheet(const Record& record);

}  // namespace host
