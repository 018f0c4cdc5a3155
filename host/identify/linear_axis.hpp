// The rigid axis without Coulomb friction, continuous and sampled: basis of every design and estimate.
#pragma once

#include <Eigen/Core>

#include "sim/drive_description.hpp"

namespace host {

/// Inertia and viscous friction of a drive. Rotary: kg m^2 and Nm s/rad; linear: kg and N s/m.
struct RigidAxis {
  double inertia = 0.0;          ///< J > 0
  double viscous = 0.0;          ///< B, any sign (an estimate may be negative)
  double effort_per_volt = 0.0;  ///< Ka*Kt, Nm/V or N/V, > 0
  double lead = 1.0;             ///< rg, dx/dt = rg*w

  double gain() const { return effort_per_volt / inertia; }  ///< Kw of eq. (3), (rad/s^2)/V or (m/s^2)/V
  double pole() const { return -viscous / inertia; }         ///< pw of eq. (3), 1/s
};

/// Force on the table for a volt of the command, N/V.
double newton_per_volt(const RigidAxis& axis, sim::DriveKind kind);

/// Takes J and B from the model's `inertia` and `viscous` effects. Throws Failure(bad_input) if the inertia is absent
/// or not positive, or if the drive has no torque or force constant. A model without `viscous` has B = 0.
RigidAxis rigid_axis(const sim::DriveDescription& model);

/// Eq. (7): x(k+1), w(k+1) from x(k), w(k) and a command held over the period.
struct SampledAxis {
  Eigen::Matrix2d Ad;
  Eigen::Vector2d Bd;
};
SampledAxis sample_axis(const RigidAxis& axis, double sample_period_s);

/// Eqs. (15), (16): state [x, w, d] with the disturbance d in volts at the control signal.
struct AugmentedAxis {
  Eigen::Matrix3d A;
  Eigen::Vector3d B;
  Eigen::Matrix<double, 3, 2> W;               ///< input matrix of the process noise [u~, wd]
  Eigen::Matrix<double, Eigen::Dynamic, 3> C;  ///< 2x3 with a tachometer, 1x3 with the encoder only
};
AugmentedAxis augment_axis(const SampledAxis& axis, bool has_tachometer);

}  // namespace host
