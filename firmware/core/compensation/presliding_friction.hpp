// Friction that builds up over the travel after a reversal: elastic microslip, as LuGre describes it.
#pragma once

#include <array>

#include "firmware/core/control/friction_feedforward.hpp"

namespace firmware {

template <typename Scalar>
struct PreslidingParameters {
  bool on = false;
  Scalar stiffness_V_per_rad{};  ///< sigma0 of the contact, V per rad (m) of travel; > 0
  Scalar damping_V_s_per_rad{};  ///< sigma1, V per rad/s (m/s); >= 0
};

/// The contact's deflection times its stiffness, v, follows the sliding friction F(w) over the travel:
///     dv/dx = sigma0 (1 - v/F),   hence   v(k+1) = F + (v(k) - F) exp(-sigma0 |dx| / |F|),
/// and the drive must overcome v + sigma1/sigma0 dv/dt. The travel over which v builds up is computed from the mean of
/// the direction's static and Coulomb friction, so that a step of the control law needs no division.
template <typename Scalar>
class PreslidingFriction {
 public:
  constexpr void configure(const PreslidingParameters<Scalar>& parameters, const FrictionParameters<Scalar>& friction,
                           Scalar sample_period_s) {
    const Scalar rise = parameters.stiffness_V_per_rad * sample_period_s;
    damping_samples_ = parameters.damping_V_s_per_rad / rise;
    const auto rate = [rise](const FrictionDirection<Scalar>& side) {
      const Scalar level = (side.static_V + side.coulomb_V) * Scalar(0.5f);
      return level > Scalar(0) ? rise / level : Scalar(0);
    };
    rate_ = {rate(friction.negative), rate(friction.positive)};
    reset();
  }

  /// Relaxes the contact, as after standstill without command.
  constexpr void reset() { deflection_V_ = Scalar(0); }

  /// Mean over the period in which the reference moves at `velocity`; `sliding_V` is the friction of that velocity with
  /// its sign.
  constexpr Scalar advance(Scalar velocity, Scalar sliding_V) {
    if (velocity == Scalar(0)) return deflection_V_;
    const bool forward = velocity > Scalar(0);
    const Scalar speed = forward ? velocity : Scalar(0) - velocity;
    const Scalar before_V = deflection_V_;
    deflection_V_ = sliding_V + (before_V - sliding_V) * exp_negative(speed * rate_[forward ? 1 : 0]);
    return (before_V + deflection_V_) * Scalar(0.5f) + damping_samples_ * (deflection_V_ - before_V);
  }

 private:
  std::array<Scalar, 2> rate_{};  ///< backward, forward
  Scalar damping_samples_{};
  Scalar deflection_V_{};
};

}  // namespace firmware
