// Acceleration that is consistent with a torque or force held over each sample.
#pragma once

#include <vector>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Acceleration at the rows without delay, rad/s^2 or m/s^2; `speed` is smooth_speed() at the same cut-off. For a
/// position it is the second difference over neighbouring rows, for a speed channel the central difference. If the
/// torque or force on a mass is held from row to row, both give exactly the mean of its values before and after the
/// row. Two central differences would reduce a torque at a tenth of the sampling rate by 10 %.
std::vector<double> smooth_acceleration(const Record& record, const sim::DataSheet& data, double cutoff_Hz,
                                        bool by_speed, const std::vector<double>& speed);

}  // namespace host
