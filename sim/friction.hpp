// Friction of a sliding contact, eqs. (17) to (19), and the motion of one mass under it with true sticking: the instant
// of zero speed is found inside the step.
#pragma once

#include <algorithm>
#include <cmath>

#include "sim/drive.hpp"
#include "sim/exponential_step.hpp"

namespace sim {

/// Limits friction to >= 0, so that it never drives, whatever values a fit tries.
inline FrictionPoint never_driving(const FrictionPoint& friction) {
  return friction.effort < 0.0 ? FrictionPoint{0.0, 0.0} : friction;
}

/// Eq. (19) without its viscous term, at speed >= 0, with static friction `breakaway`. Omega = 0 means exp(-w/0) = 0.
inline FrictionPoint stribeck_curve(const FrictionSide& side, double breakaway, double speed) {
  const double fading = side.omega1 > 0.0 ? decay(speed / side.omega1) : 0.0;
  const double rising = side.omega2 == side.omega1 ? fading : (side.omega2 > 0.0 ? decay(speed / side.omega2) : 0.0);
  double slope = 0.0;
  if (side.omega1 > 0.0) slope -= breakaway * fading / side.omega1;
  if (side.omega2 > 0.0) slope += side.coulomb * rising / side.omega2;
  return {breakaway * fading + side.coulomb * (1.0 - rising), slope};
}

[[gnu::always_inline]] inline FrictionPoint SlidingCurve::dry(double speed, double breakaway_factor) const {
  const double fading = rate1 > 0.0 ? decay(speed * rate1) : 0.0;
  const double rising = rate1 == rate2 ? fading : (rate2 > 0.0 ? decay(speed * rate2) : 0.0);
  const double all_static = breakaway_factor * breakaway;
  return {coulomb + (all_static * fading - coulomb * rising),
          (coulomb * rate2) * rising - (all_static * rate1) * fading};
}

/// One mass while its friction acts.
struct SlidingMass {
  double x;
  double w;
  double mobility;  ///< 1/inertia
  double lead;
};

/// A step in one direction: friction linearised at its start, the linear equation solved exactly.
struct SmoothStep {
  double acceleration;  ///< at the start, in the direction of motion
  double lambda;        ///< its slope over speed, 1/s

  SmoothStep(double push, const FrictionPoint& friction, double mobility)
      : acceleration((push - friction.effort) * mobility), lambda(-friction.slope * mobility) {}

  double speed_after(double speed, double duration_s, const ExponentialFactors& factors) const {
    return speed + factors.phi1 * (duration_s * acceleration);
  }
  double way_after(double speed, double duration_s, const ExponentialFactors& factors) const {
    return duration_s * (speed + duration_s * factors.phi2 * acceleration);
  }
};

/// The general case of `slide`, with stops and starts within the step.
template <typename Contact>
[[gnu::noinline]] void slide_through_stops(SlidingMass& mass, double effort, double duration_s, Contact& contact) {
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
    const SmoothStep step(direction * effort, contact.sliding(direction > 0.0 ? 0 : 1, speed), mass.mobility);
    if (speed == 0.0 &&
        step.acceleration <= 0.0) {  // breakaway level and curve are equal at zero speed, up to rounding
      contact.rested(left);
      return;
    }
    double duration = left;
    ExponentialFactors factors = exponential_factors(step.lambda * duration);
    double end = step.speed_after(speed, duration, factors);
    const bool stops = speed > 0.0 && end <= 0.0;
    if (stops) {
      duration = std::min(left, time_to_zero(speed, step.acceleration, step.lambda));
      factors = exponential_factors(step.lambda * duration);
      end = 0.0;
    }
    mass.x += mass.lead * direction * step.way_after(speed, duration, factors);
    mass.w = direction * end;
    if (stops) contact.came_to_rest();
    left -= duration;
  }
}

/// Moves a mass for `duration_s` under a constant effort. `Contact` gives its friction:
///   FrictionPoint sliding(int side, double speed)   magnitude while moving forward (side 0) or backward (side 1)
///   double breakaway(int side)                      level that the effort must pass at standstill
///   void broke_away(), came_to_rest(), rested(double duration_s)
/// The step linearises friction at its start and solves the linear equation exactly (order 2; exact where friction is
/// Coulomb and viscous). Bounded: a contact can stop and start at most a few times in a step.
template <typename Contact>
[[gnu::always_inline]] inline void slide(SlidingMass& mass, double effort, double duration_s, Contact& contact) {
  const double direction = mass.w > 0.0 ? 1.0 : -1.0, speed = std::abs(mass.w);
  if (speed > 0.0) {
    const SmoothStep step(direction * effort, contact.sliding(direction > 0.0 ? 0 : 1, speed), mass.mobility);
    const ExponentialFactors factors = exponential_factors(step.lambda * duration_s);
    const double end = step.speed_after(speed, duration_s, factors);
    if (end > 0.0) {
      mass.x += mass.lead * direction * step.way_after(speed, duration_s, factors);
      mass.w = direction * end;
      return;
    }
  }
  slide_through_stops(mass, effort, duration_s, contact);
}

/// `slide` for an effort that changes once, `change_s` after the start. False, with the mass unchanged, if it may stop
/// within the step. Friction is linearised once for both parts: exact for Coulomb and viscous friction, otherwise of
/// order 2.
template <typename Contact>
inline bool slide_through_change(SlidingMass& mass, double before, double after, double change_s, double duration_s,
                                 Contact& contact) {
  const double direction = mass.w > 0.0 ? 1.0 : -1.0, speed = std::abs(mass.w);
  if (speed == 0.0) return false;
  const SmoothStep step(direction * before, contact.sliding(direction > 0.0 ? 0 : 1, speed), mass.mobility);
  const double later_s = duration_s - change_s, change = direction * (after - before) * mass.mobility;
  const ExponentialFactors all = exponential_factors(step.lambda * duration_s);
  const ExponentialFactors later = exponential_factors(step.lambda * later_s);
  // Each part is monotone: if the mass moves at both ends, it moves throughout.
  const double unchanged = step.speed_after(speed, duration_s, all);
  const double end = unchanged + later.phi1 * later_s * change;
  if (!(unchanged > 0.0 && end > 0.0)) return false;
  mass.x += mass.lead * direction * (step.way_after(speed, duration_s, all) + later.phi2 * later_s * later_s * change);
  mass.w = direction * end;
  return true;
}

/// The friction of one contact, linearised once for several consecutive short steps, which then need only a few
/// operations each.
class LinearisedContact {
 public:
  template <typename Contact>
  [[gnu::always_inline]] LinearisedContact(double w, double mobility, double duration_s, const Contact& contact)
      : direction_(w > 0.0 ? 1.0 : (w < 0.0 ? -1.0 : 0.0)) {
    const double speed = std::abs(w);
    const FrictionPoint friction = contact.sliding(w > 0.0 ? 0 : 1, speed);
    kick_ = mobility * duration_s * exponential_factors(-friction.slope * mobility * duration_s).phi1;
    kept_ = 1.0 - kick_ * friction.slope;
    lost_ = direction_ * kick_ * (friction.effort - friction.slope * speed);
  }

  /// The speed after a step under a constant effort.
  double after(double w, double effort) const { return kept_ * w + (kick_ * effort - lost_); }
  /// Whether a mass with this speed at the end of a step still slides in its direction; never from rest.
  bool holds_for(double end) const { return direction_ * end > 0.0; }

 private:
  double direction_;
  double kick_;         ///< speed per effort
  double kept_, lost_;  ///< remaining part of the speed, and speed lost by Coulomb friction
};

}  // namespace sim
