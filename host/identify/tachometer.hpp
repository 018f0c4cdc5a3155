// Calibration of the tachometer by the encoder: gain, offset, noise.
#pragma once

#include <optional>
#include <vector>

#include "host/identify/rigid_estimate.hpp"
#include "host/record/record.hpp"

namespace host {

/// w_measured = gain * w + offset + noise.
struct TachometerCalibration {
  Estimate gain;            ///< 1 is right
  Estimate offset;          ///< rad/s or m/s
  double proportion = 1.0;  ///< gain of a tachometer without offset: known from a single speed, too
};

/// Compares the tachometer's integral with the encoder's travel over windows of 0.1 s, all records together.
/// Empty when a record lacks either sensor or the axis travelled less than 100 encoder steps.
std::optional<TachometerCalibration> calibrate_tachometer(const std::vector<Record>& records,
                                                          const sim::DataSheet& data);

/// Removes the calibration from the records' speed: w = (w_measured - offset) / gain.
void apply_calibration(const TachometerCalibration& calibration, std::vector<Record>& records);

/// Variance of the tachometer while the axis stands (46): stretches of 0.2 s in which the encoder does not move by more
/// than one step, each about its own mean. Empty when there are fewer than three such stretches, or a sensor is
/// missing.
std::optional<double> standstill_variance(const std::vector<Record>& records, const sim::DataSheet& data);

}  // namespace host
