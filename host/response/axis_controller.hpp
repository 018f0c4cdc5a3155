// Frequency response of the board's controller: estimator, feedback, filters (firmware/core/axis.hpp).
#pragma once

#include <Eigen/Core>
#include <complex>

#include "firmware/core/axis_parameters.hpp"

namespace host {

/// With the loop cut at the drive's input, u = -C y for y = [position, speed]. C includes the estimator's input from
/// the command.
class AxisController {
 public:
  explicit AxisController(const firmware::AxisParameters<float>& parameters);

  /// C at a frequency below half the sample rate: V per mm (m), V per rad/s (m/s).
  Eigen::RowVector2cd at(double f_Hz) const;

  /// The part of a command added at its output that reaches the drive, if the drive does not respond.
  std::complex<double> own_response(double f_Hz) const;

  /// Command for a reference, V per mm (m), if the drive does not respond: feedback, feed-forward of the reference and
  /// of viscous friction.
  std::complex<double> of_reference(double f_Hz) const;

  double sample_period_s() const { return period_s_; }
  bool uses_speed() const { return uses_speed_; }

 private:
  std::complex<double> filter(double f_Hz) const;
  struct Parts {
    std::complex<double> of_command;  ///< from the command to the controller's output, negative
    Eigen::RowVector2cd of_answer;
  };
  Parts parts(double f_Hz) const;

  double period_s_;
  bool uses_speed_;
  Eigen::Matrix3d A_, rest_;  ///< rest_: I - Kobs C
  Eigen::Vector3d B_;
  Eigen::Matrix<double, 3, 2> Kobs_;
  Eigen::RowVector3d gain_;  ///< of the estimated state
  firmware::FilterParameters<float> filters_;
  firmware::ReferenceFeedforward<float> feedforward_;
  double lead_, viscous_ = 0.0;  ///< viscous_: V per rad/s (m/s) of friction feed-forward
};

}  // namespace host
