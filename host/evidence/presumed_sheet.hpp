// What a record alone says of its drive, where nobody gives a data sheet.
#pragma once

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// The record's kind of drive, and the travel per angle that its position and speed show together (1 where it holds one
/// of them): enough for the gate to hold other records and channels against it, without an opinion on effort.
sim::DriveDescription presumed_sheet(const Record& record);

}  // namespace host
