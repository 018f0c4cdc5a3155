// Friction feed-forward: eq. (19), driven by the reference velocity and continuous through zero.
#pragma once

#include "firmware/core/exp_negative.hpp"

namespace firmware {

/// The friction curve of one direction of motion. All values are magnitudes (not negative), for both directions alike;
/// volts are torque or force divided by Ka*Kt (Nm/V) or by the force constant (N/V).
template <typename Scalar>
struct FrictionDirection {
  Scalar static_V{};
  Scalar coulomb_V{};
  Scalar viscous_V_s_per_rad{};  ///< V per rad/s (V per m/s), added to what the drive model already contains
  Scalar omega1_rad_s{};         ///< rad/s (m/s); 0: static friction ends with the first motion
  Scalar omega2_rad_s{};         ///< rad/s (m/s); 0: Coulomb friction is there from the first motion
};

template <typename Scalar>
struct FrictionParameters {
  FrictionDirection<Scalar> positive{};
  FrictionDirection<Scalar> negative{};
  /// Below this speed the output falls in proportion to speed, so that it is continuous and 0 at rest; > 0.
  Scalar blend_velocity_rad_s{};
};

template <typename Scalar>
class FrictionFeedforward {
 public:
  constexpr void configure(const FrictionParameters<Scalar>& parameters) {
    blend_velocity_ = parameters.blend_velocity_rad_s;
    positive_ = Curve(parameters.positive, blend_velocity_);
    negative_ = Curve(parameters.negative, blend_velocity_);
  }

  /// Volts that overcome friction at the reference velocity (rad/s or m/s); the sign is that of the velocity.
  constexpr Scalar operator()(Scalar reference_velocity) const {
    return reference_velocity >= Scalar(0) ? magnitude(positive_, reference_velocity)
                                           : Scalar(0) - magnitude(negative_, Scalar(0) - reference_velocity);
  }

 private:
  /// A direction with its divisions done beforehand. A rate of 0 stands for omega = 0: the exponential is 0.
  struct Curve {
    Scalar static_V{}, coulomb_V{}, viscous{}, rate1{}, rate2{}, blend_slope{};

    constexpr Curve() = default;
    constexpr Curve(const FrictionDirection<Scalar>& direction, Scalar blend_velocity)
        : static_V(direction.static_V),
          coulomb_V(direction.coulomb_V),
          viscous(direction.viscous_V_s_per_rad),
          rate1(direction.omega1_rad_s > Scalar(0) ? Scalar(1) / direction.omega1_rad_s : Scalar(0)),
          rate2(direction.omega2_rad_s > Scalar(0) ? Scalar(1) / direction.omega2_rad_s : Scalar(0)) {
      blend_slope = at(blend_velocity) / blend_velocity;
    }

    constexpr Scalar at(Scalar speed) const {
      const Scalar decay1 = rate1 > Scalar(0) ? exp_negative(speed * rate1) : Scalar(0);
      const Scalar decay2 = rate2 > Scalar(0) ? exp_negative(speed * rate2) : Scalar(0);
      return static_V * decay1 + coulomb_V * (Scalar(1) - decay2) + viscous * speed;
    }
  };

  constexpr Scalar magnitude(const Curve& curve, Scalar speed) const {
    return speed < blend_velocity_ ? speed * curve.blend_slope : curve.at(speed);
  }

  Curve positive_{};
  Curve negative_{};
  Scalar blend_velocity_{};
};

}  // namespace firmware
