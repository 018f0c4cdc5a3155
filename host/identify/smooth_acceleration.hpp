// Acceleration consistent with a torque or force held over each sample.
#pragma once

#include <vector>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Acceleration at the rows, rad/s^2 or m/s^2, free of delay; `speed` is smooth_speed() at the same cut-off. From a
/// position its second difference over neighbouring rows, from a speed channel the central difference: a mass that is
/// pushed by an effort held from row to row shows in both exactly the mean of the two efforts that meet at a row.
/// Differencing the position's central difference again would make a push at a tenth of the sampling rate 10 % smaller.
std::vector<double> smooth_acceleration(const Record& record, const sim::DataSheet& data, double cutoff_Hz,
                                        bool by_speed, const std::vector<double>& speed);

}  // namespace host
