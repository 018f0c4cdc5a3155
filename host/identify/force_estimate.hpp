// What the estimator's disturbance says about a process force.
#pragma once

#include "host/identify/axis_design.hpp"

namespace host {

/// The disturbance holds friction and process force, eq. (2). With friction feed-forward the estimator does not see the
/// identified friction, so that the board's channel d_hat_V is the process force and what the friction model misses.
struct ForceEstimate {
  double newton_per_V = 0.0;  ///< force on the table
  double band_N = 0.0;        ///< half width of the 95 % interval from the noise of sensors and converter
  double delay_s = 0.0;       ///< by which the estimate lags behind a force that changes steadily
};

/// For a model as exact as the design assumes.
ForceEstimate force_estimate(const AxisDesign& design, const sim::DataSheet& data);

}  // namespace host
