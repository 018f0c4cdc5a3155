// Acceleration consistent with a torque or force held over each sample.
#pragma once

#include <vector>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Acceleration at the rows, rad/s^2 or m/s^2, free of delay; `speed` is smooth_speed() at the same cut-off. From a
/// position its second difference over neighbouring rows, from a speed channel the central difference: for a mass
/// driven by an effort that is held from row to row, both give exactly the mean of the two efforts that meet at a row.
/// Taking the central difference twice would reduce an effort at a tenth of the sampling rate by 10 %.
std::vector<double> smooth_acceleration(const Record& record, const sim::DataSheet& data, double cutoff_Hz,
                                        bool by_speed, const std::vector<double>& speed);

}  // namespace host
