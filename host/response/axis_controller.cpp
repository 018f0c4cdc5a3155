#include "host/response/axis_controller.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace host {

AxisController::AxisController(const firmware::AxisParameters<float>& p)
    : period_s_(static_cast<double>(p.sample_period_s)),
      uses_speed_(p.tachometer_fitted),
      filters_(p.filters),
      feedforward_(p.zero_phase_feedforward_on
                       ? firmware::zero_phase_feedforward(p.drive, p.Kc, p.lead * p.sample_period_s)
                       : firmware::backward_difference_feedforward(p.Kc)),
      lead_(static_cast<double>(p.lead)) {
  const auto real = [](float value) { return static_cast<double>(value); };
  A_ << 1.0, real(p.drive.Ad12), -real(p.drive.Bd1), 0.0, real(p.drive.Ad22), -real(p.drive.Bd2), 0.0, 0.0, 1.0;
  B_ << real(p.drive.Bd1), real(p.drive.Bd2), 0.0;
  for (Eigen::Index row = 0; row < 3; ++row)
    for (Eigen::Index column = 0; column < 2; ++column)
      Kobs_(row, column) = column == 1 && !uses_speed_
                               ? 0.0
                               : real(p.Kobs[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)]);
  rest_.setIdentity();
  rest_.leftCols<2>() -= Kobs_;
  if (p.friction_feedforward_on)
    viscous_ = 0.5 * (real(p.friction.positive.viscous_V_s_per_rad) + real(p.friction.negative.viscous_V_s_per_rad));
  gain_ << real(p.Kc[0]), real(p.Kc[1]), p.disturbance_cancellation_on ? -1.0 : 0.0;
}

/// Evaluates the filters from their coefficients: s / w = (z - 1) / (g (z + 1)); the damping follows from a1 and g.
std::complex<double> AxisController::filter(double f_Hz) const {
  using Complex = std::complex<double>;
  const Complex s = Complex(0.0, std::tan(std::numbers::pi * f_Hz * period_s_));  // for w = g
  Complex product = 1.0;
  for (const firmware::BiquadParameters<float>& one : filters_) {
    if (!one.on) continue;
    const double a1 = static_cast<double>(one.a1), g = static_cast<double>(one.a2) / a1;
    const double twice_damping = (1.0 / a1 - 1.0) / g - g;
    const Complex poles = s * s + twice_damping * g * s + g * g;
    product *= one.is_low_pass ? g * g / poles : 1.0 + static_cast<double>(one.of_band) * g * s / poles;
  }
  return product;
}

AxisController::Parts AxisController::parts(double f_Hz) const {
  using Complex = std::complex<double>;
  const Complex delay = std::polar(1.0, -2.0 * std::numbers::pi * f_Hz * period_s_);
  // z_hat(k) = (I - Kobs C)(A z_hat(k-1) + B u(k-1)) + Kobs y(k), eq. (43).
  const Eigen::Matrix3cd memory = Eigen::Matrix3cd::Identity() - delay * (rest_ * A_).cast<Complex>();
  const Eigen::PartialPivLU<Eigen::Matrix3cd> solved(memory);
  const Eigen::RowVector3cd gain = filter(f_Hz) * gain_.cast<Complex>();
  return {delay * (gain * solved.solve((rest_ * B_).cast<Complex>()))(0), gain * solved.solve(Kobs_.cast<Complex>())};
}

Eigen::RowVector2cd AxisController::at(double f_Hz) const {
  const Parts found = parts(f_Hz);
  return found.of_answer / (1.0 + found.of_command);
}

std::complex<double> AxisController::own_response(double f_Hz) const { return 1.0 / (1.0 + parts(f_Hz).of_command); }

std::complex<double> AxisController::of_reference(double f_Hz) const {
  const std::complex<double> z = std::polar(1.0, 2.0 * std::numbers::pi * f_Hz * period_s_);
  std::complex<double> weight = static_cast<double>(feedforward_.velocity), ahead = 1.0;
  for (const float change : feedforward_.change) {
    weight += static_cast<double>(change) * ahead * (z - 1.0);
    ahead *= z;
  }
  const std::complex<double> velocity = (1.0 - 1.0 / z) / (lead_ * period_s_);
  // The estimator does not see the friction feed-forward, which uses the next sample's velocity.
  return filter(f_Hz) * (gain_(0) + weight * velocity) * own_response(f_Hz) + viscous_ * z * velocity;
}

}  // namespace host
