// What the estimator's disturbance says about a process force.
#pragma once

#include "host/identify/axis_design.hpp"
#include "host/record/record.hpp"

namespace host {

/// The disturbance contains friction and process force, eq. (2). With friction feed-forward, the board's channel
/// d_hat_V contains only the process force and the error of the friction model.
struct ForceEstimate {
  double newton_per_V = 0.0;  ///< force on the table
  double band_N = 0.0;        ///< half width of the 95 % interval from the noise of sensors and converter
  double delay_s = 0.0;       ///< by which the estimate lags behind a force that changes steadily
};

/// For a model as exact as the design assumes.
ForceEstimate force_estimate(const AxisDesign& design, const sim::DataSheet& data);

/// Column of records: process force on the table, N, positive against motion in the positive direction.
inline constexpr const char* kProcessForce = "process_force_N";
/// Keys of the header: half width of the 95 % interval, N; delay, s.
inline constexpr const char* kProcessForceBand = "process_force_band_N";
inline constexpr const char* kProcessForceDelay = "process_force_delay_s";

/// Adds the process force to a record of a board: its estimated disturbance and its friction feed-forward (columns
/// d_hat_V, u_friction_V), less the friction and the loads of the model at the reference. `Kobs`: the board's
/// estimator. Throws Failure(bad_input) naming a column that is missing.
void add_process_force(Record& record, const sim::DriveDescription& model,
                       const Eigen::Matrix<double, 3, Eigen::Dynamic>& Kobs);

}  // namespace host
