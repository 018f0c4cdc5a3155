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
  double proportion = 1.0;  ///< gain for an assumed offset of zero; a single speed determines it
};

/// Compares the tachometer's integral with the encoder's travel over windows of 0.1 s, all records together. Empty if a
/// record lacks one of the sensors or the axis travelled less than 100 encoder steps.
std::optional<TachometerCalibration> calibrate_tachometer(const std::vector<Record>& records,
                                                          const sim::DataSheet& data);

/// Removes the calibration from the records' speed: w = (w_measured - offset) / gain.
void apply_calibration(const TachometerCalibration& calibration, std::vector<Record>& records);

/// Variance of the tachometer at standstill (46), from intervals of 0.2 s in which the encoder moves by at most one
/// step, each about its own mean. Empty if there are fewer than three such intervals or a sensor is missing.
std::optional<double> standstill_variance(const std::vector<Record>& records, const sim::DataSheet& data);

/// Variance of the tachometer over `count` rows in motion, from second differences of the speed (1 + 4 + 1 = 6), which
/// slow motion hardly affects. The motion that the command causes within a period is subtracted by `model`: feedback
/// returns the tachometer's noise as such motion, correlated with the noise itself. Empty for fewer than three rows, or
/// without a command or a speed.
std::optional<double> moving_variance(const Record& record, std::size_t begin, std::size_t count,
                                      const sim::DriveDescription& model);

}  // namespace host
