// What the records themselves tell of the sensors.
#pragma once

#include <vector>

#include "host/record/measurements.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Completes a data sheet by what the training records show: an encoder's step, a tachometer's noise. Without them a
/// window in which the axis stands has a floor of nothing.
sim::DriveDescription with_measured_sensors(const sim::DriveDescription& model, const Measurements& measured);

/// The same by some records.
sim::DriveDescription with_measured_sensors(const sim::DriveDescription& model,
                                            const std::vector<const Record*>& records);

}  // namespace host
