// Resolution and noise of the sensors, estimated from the records.
#pragma once

#include <vector>

#include "host/record/measurements.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Adds the properties of sensors that the training records show to a data sheet: the encoder's step, if it is missing
/// or finer than that of all records, and the tachometer's noise. Without them the noise floor of a window at
/// standstill would be zero.
sim::DriveDescription with_measured_sensors(const sim::DriveDescription& model, const Measurements& measured);

/// The same from the given records.
sim::DriveDescription with_measured_sensors(const sim::DriveDescription& model,
                                            const std::vector<const Record*>& records);

}  // namespace host
