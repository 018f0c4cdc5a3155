// Friction of a sliding contact, eqs. (17) to (19), and the motion of one mass under it with true sticking: the instant
// of zero speed is found inside the step.
#pragma once

#include <cmath>

#include "sim/drive.hpp"
#include "sim/exponential_step.hpp"

namespace sim {

/// Eq. (19) without its viscous term, at speed >= 0, with static friction `breakaway`. Omega = 0 means exp(-w/0) = 0.
inline FrictionPoint stribeck_curve(const FrictionSide& side, double breakaway, double speed) {
  const double fading = side.omega1 > 0.0 ? std::exp(-speed / side.omega1) : 0.0;
  const double rising =
      side.omega2 == side.omega1 ? fading : (side.omega2 > 0.0 ? std::exp(-speed / side.omega2) : 0.0);
  double slope = 0.0;
  if (side.omega1 > 0.0) slope -= breakaway * fading / side.omega1;
  if (side.omega2 > 0.0) slope += side.coulomb * rising / side.omega2;
  return {breakaway * fading + side.coulomb * (1.0 - rising), slope};
}

/// One mass while its friction acts.
struct SlidingMass {
  double x;
  double w;
  double mobility;  ///< 1/inertia
  double lead;
};

/// Moves a mass for `duration_s` under a constant effort. `Contact` tells its friction:
///   FrictionPoint sliding(int side, double speed)   magnitude while moving forward (side 0) or backward (side 1)
///   double breakaway(int side)                      level that the effort must pass at standstill
///   void broke_away(), came_to_rest(), rested(double duration_s)
/// The step linearises friction at its start and solves the linear equation exactly (order 2; exact where friction is
/// Coulomb and viscous). Bounded: a contact can stop and start at most a few times in a step.
template <typename Contact>
inline void slide(SlidingMass& mass, double effort, double duration_s, Contact& contact) {
  constexpr int kMostEvents = 8;
  double left = duration_s;
  for (int event = 0; event < kMostEvents && left > 0.0; ++event) {
    double direction = mass.w > 0.0 ? 1.0 : -1.0;
    if (mass.w == 0.0) {
      direction = effort > 0.0 ? 1.0 : -1.0;
      if (std::abs(effort) <= contact.breakaway(direction > 0.0 ? 0 : 1)) {
        contact.rested(left);
        return;
      }
      contact.broke_away();
    }
    const double speed = std::abs(mass.w);
    const FrictionPoint friction = contact.sliding(direction > 0.0 ? 0 : 1, speed);
    const double acceleration = (direction * effort - friction.effort) * mass.mobility;
    const double lambda = -friction.slope * mass.mobility;
    if (speed == 0.0 && acceleration <= 0.0) {  // breakaway level and curve agree at zero speed, up to rounding
      contact.rested(left);
      return;
    }
    double duration = left;
    ExponentialFactors factors = exponential_factors(lambda * duration);
    double end = speed + duration * factors.phi1 * acceleration;
    const bool stops = speed > 0.0 && end <= 0.0;
    if (stops) {
      duration = std::min(left, time_to_zero(speed, acceleration, lambda));
      factors = exponential_factors(lambda * duration);
      end = 0.0;
    }
    mass.x += mass.lead * direction * duration * (speed + duration * factors.phi2 * acceleration);
    mass.w = direction * end;
    if (stops) contact.came_to_rest();
    left -= duration;
  }
}

/// The contact of a drive that has nothing but eq. (19): the predictor's innermost loop.
template <bool kStribeck>
struct PlainContact {
  const std::array<SlidingCurve, 2>& sides;

  FrictionPoint sliding(int side, double speed) const {
    const SlidingCurve& curve = sides[static_cast<std::size_t>(side)];
    if constexpr (!kStribeck) return {curve.coulomb + curve.viscous * speed, curve.viscous};
    const double fading = curve.rate1 > 0.0 ? std::exp(-speed * curve.rate1) : 0.0;
    const double rising =
        curve.rate1 == curve.rate2 ? fading : (curve.rate2 > 0.0 ? std::exp(-speed * curve.rate2) : 0.0);
    const double static_part = curve.breakaway * fading, missing = curve.coulomb * rising;
    return {static_part + curve.coulomb - missing + curve.viscous * speed,
            missing * curve.rate2 - static_part * curve.rate1 + curve.viscous};
  }
  double breakaway(int side) const { return sides[static_cast<std::size_t>(side)].breakaway; }
  void broke_away() const {}
  void came_to_rest() const {}
  void rested(double) const {}
};

}  // namespace sim
