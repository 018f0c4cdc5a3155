// Repeatable part of the residual, which a model could explain; the rest is noise.
#pragma once

#include <optional>

#include "host/effort/effort_rows.hpp"

namespace host {

struct Repeatability {
  double share = 0.0;    ///< part of the residual's square that repeated, 0 to 1
  double floor = 0.0;    ///< RMS of the rest, Nm or N: the machine's noise floor
  double seconds = 0.0;  ///< duration of the motion that was compared with its repetition
};

/// Compares the residual of every row with that one period of the motion later, over the records whose motion repeats.
/// Empty if that covers less than two seconds in total.
std::optional<Repeatability> repeatability(const EffortRows& rows, const Eigen::VectorXd& residual);

}  // namespace host
