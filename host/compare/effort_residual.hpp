// The residual of a model, sample by sample: torque or force at the motor, and speed at the tachometer.
#pragma once

#include <vector>

#include "host/compare/comparison.hpp"
#include "host/compare/residual_effort.hpp"

namespace host {

/// Samples of a record in motion, thinned; all vectors have the same length.
struct ResidualSamples {
  std::vector<std::size_t> row;  ///< index of the row in its record
  std::vector<double> t_s;
  std::vector<double> x;             ///< smoothed travel, mm or m
  std::vector<double> w;             ///< smoothed speed, rad/s or m/s
  std::vector<double> acceleration;  ///< derivative of w
  std::vector<double> effort;        ///< torque or force of the motor, Nm or N
  std::vector<double> missing;       ///< torque or force that the motion needed beyond the model, Nm or N
  std::vector<double> tach_error;    ///< tachometer minus its model at the smoothed speed; empty if there is none
};

/// Residuals of `model` on every `stride`-th moving sample of a record. Friction is the model's curve at the smoothed
/// speed. Effects with memory are left out, and a load on a spring or with a gap moves with the motor.
ResidualSamples residual_samples(const sim::DriveDescription& model, const PreparedRecord& prepared,
                                 std::size_t stride);

/// Residuals of all records of a set in sequence.
ResidualSamples residual_samples(const sim::DriveDescription& model, const RecordSet& set, std::size_t stride);

/// The same as averages at the samples of residual_effort(), for models that have an inverse (has_inverse). It is
/// exact. A prediction, in contrast, drifts from the measured motion and so has a different friction.
ResidualEffort residual_of_inverse(const sim::DriveDescription& model, const RecordSet& set);

}  // namespace host
