// The smallest step of travel that a record can show.
#pragma once

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// In mm or m: the data sheet's resolution, or the step of the record's positions if that is coarser. If the data sheet
/// has no resolution, the smallest step between samples of the record. 0 for a record without position or motion.
double encoder_step(const Record& record, const sim::DataSheet& data);

}  // namespace host
