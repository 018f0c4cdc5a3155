// Separates the repeatable part of the residual, which a model could explain, from the noise.
#pragma once

#include <optional>

#include "host/effort/effort_rows.hpp"

namespace host {

struct Repeatability {
  double share = 0.0;    ///< part of the squared residual that repeated, 0 to 1
  double floor = 0.0;    ///< RMS of the rest: the machine's noise floor, Nm or N
  double seconds = 0.0;  ///< duration of the motion compared with its repetition
};

/// Compares the residual of every row with the residual one period of the motion later, in records whose motion
/// repeats. Empty if these have less than two seconds of motion in total.
std::optional<Repeatability> repeatability(const EffortRows& rows, const Eigen::VectorXd& residual);

}  // namespace host
