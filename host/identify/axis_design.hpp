// Estimator and controller of an axis from its model: Kalman gain and state feedback.
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "host/identify/linear_axis.hpp"

namespace host {

/// Tuning parameters of the design. The defaults are those of the paper: eqs. (10), (12), (47), (48) and p. 1504.
struct DesignOptions {
  std::optional<double> tach_variance;      ///< Rw, (rad/s)^2 or (m/s)^2; default 0.05, linear: the drive's own
  double disturbance_variance = 0.01;       ///< Rwd, V^2 per sample, > 0; larger: faster disturbance estimate
  std::optional<double> command_variance;   ///< Ru, V^2; default du^2/12
  std::optional<double> position_variance;  ///< Rx, mm^2 or m^2, > 0; default dx^2/12
  double bandwidth_Hz = 30.0;               ///< of the closed-loop poles, > 0 and below half the sampling rate
  double damping = 0.7;                     ///< of the closed-loop poles, > 0
  bool zero_phase = true;                   ///< zero-phase feed-forward; else of the reference velocity alone, eq. (50)
};

/// The steady-state estimator (43) and feedback (50) of one axis.
struct AxisDesign {
  RigidAxis axis;
  AugmentedAxis model;
  DesignOptions used;  ///< all options with their defaults (tach_variance is empty without a tachometer)
  Eigen::Matrix<double, 3, Eigen::Dynamic> Kobs;  ///< 3x2, or 3x1 without a tachometer; for the measurement update
  std::vector<std::complex<double>>
      observer_poles;                  ///< poles of (I - Kobs C) A, by ascending frequency, upper one of a pair first
  std::vector<double> observer_fn_Hz;  ///< |ln z| / (2 pi Ts)
  std::vector<double> observer_zeta;   ///< -cos(arg ln z)
  Eigen::RowVector2d Kc;               ///< V per mm (or m), V per rad/s (or m/s)
};

/// Designs estimator and feedback for the sampling period of the model's data sheet. Throws Failure(bad_input), with
/// the name of the model or option, if no design is possible.
AxisDesign design_axis(const sim::DriveDescription& model, const DesignOptions& options);

/// Stationary a-priori covariance P of the estimator: the stabilising solution of
/// P = A P A' - A P C'(C P C' + R)^-1 C P A' + Q, by the structure-preserving doubling algorithm.
/// Throws Failure(bad_input) if it does not converge (undetectable, or no process noise).
Eigen::Matrix3d solve_estimator_dare(const Eigen::Matrix3d& A, const Eigen::MatrixXd& C, const Eigen::Matrix3d& Q,
                                     const Eigen::MatrixXd& R);

/// Ackermann's formula: feedback that puts the poles of Ad - Bd*Kc at exp(s Ts), where s has the given natural
/// frequency and damping.
Eigen::RowVector2d place_poles(const SampledAxis& axis, double natural_frequency_Hz, double damping,
                               double sample_period_s);

}  // namespace host
