// A provisional data sheet from the record alone.
#pragma once

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// The record's kind of drive, and the travel per angle from position and speed (1 if one is missing). That suffices
/// for the gate to check other records and channels, except torque or force.
sim::DriveDescription presumed_sheet(const Record& record);

}  // namespace host
