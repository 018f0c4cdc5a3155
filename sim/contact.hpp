// Interface between a drive's contact and its motion: requirements of `slide` and its variants on a `Contact`.
#pragma once

#include <cmath>

#include "sim/drive.hpp"
#include "sim/exponential_step.hpp"
#include "sim/friction.hpp"

namespace sim {

template <typename Factors, typename... Arguments>
double product(const Factors& factors, Arguments... arguments) {
  double value = 1.0;
  for (const auto& factor : factors) value *= factor(arguments...);
  return value;
}

template <typename Terms>
double sum_at(const Terms& terms, double x) {
  double value = 0.0;
  for (const auto& term : terms) value += term(x);
  return value;
}

inline FrictionPoint operator+(const FrictionPoint& a, const FrictionPoint& b) {
  return {a.effort + b.effort, a.slope + b.slope};
}

inline FrictionPoint further_friction(const Drive& drive, int side, double speed) {
  FrictionPoint all{0.0, 0.0};
  for (const auto& further : drive.sliding_friction) all = all + further(side, speed);
  return all;
}

/// A drive with eq. (19) only, with or without the Stribeck effect: the predictor's innermost loop.
template <bool kStribeck>
struct PlainContact {
  const std::array<SlidingCurve, 2>& sides;

  explicit PlainContact(const std::array<SlidingCurve, 2>& curves) : sides(curves) {}
  PlainContact(const Drive& drive, const DriveMotion&, double /*t_s*/, double /*x*/, double /*motor*/)
      : sides(drive.curves()) {}

  [[gnu::always_inline]] FrictionPoint sliding(int side, double speed) const {
    return dry(side, speed) + viscous(side, speed);
  }
  [[gnu::always_inline]] FrictionPoint dry(int side, double speed) const {
    const SlidingCurve& curve = sides[static_cast<std::size_t>(side)];
    if constexpr (!kStribeck) return {curve.coulomb, 0.0};
    return curve.dry(speed);
  }
  FrictionPoint viscous(int side, double speed) const {
    const double coefficient = sides[static_cast<std::size_t>(side)].viscous;
    return {coefficient * speed, coefficient};
  }
  double breakaway(int side) const { return sides[static_cast<std::size_t>(side)].breakaway; }
  void broke_away() const {}
  void came_to_rest() const {}
  void rested(double) const {}
};

/// Eq. (19) and additional friction that depends on direction and speed.
struct BentContact : PlainContact<true> {
  const Drive& drive;

  BentContact(const Drive& of_drive, const DriveMotion& motion, double t_s, double x, double motor)
      : PlainContact(of_drive, motion, t_s, x, motor), drive(of_drive) {}

  FrictionPoint sliding(int side, double speed) const { return never_driving(dry(side, speed) + viscous(side, speed)); }
  FrictionPoint viscous(int side, double speed) const {
    return PlainContact::viscous(side, speed) + further_friction(drive, side, speed);
  }
};

/// A contact with additional effects; `motion` holds its state.
struct RichContact {
  const Drive& drive;
  DriveMotion& motion;
  double level;      ///< factor on Coulomb and static friction
  double viscosity;  ///< factor on viscous friction
  double carried;    ///< friction caused by the transmitted torque or force

  RichContact(const Drive& of_drive, DriveMotion& of_motion, double t_s, double x, double motor)
      : drive(of_drive),
        motion(of_motion),
        level(product(drive.level_factor, t_s, x)),
        viscosity(product(drive.viscous_factor, t_s)),
        carried(drive.transmitted_share * std::abs(motor)) {
    for (const auto& further : drive.further_level) carried += further(t_s, x);
    for (const auto& further : drive.friction_after_reversal) carried += further(std::abs(x - motion.turned_x));
  }

  FrictionPoint sliding(int side, double speed) const { return never_driving(dry(side, speed) + viscous(side, speed)); }

  FrictionPoint dry(int side, double speed) const {
    const SlidingCurve& curve = drive.curves()[static_cast<std::size_t>(side)];
    const bool remembers = drive.friction_memory_s > 0.0;
    const FrictionPoint point = curve.dry(remembers ? motion.friction_speed : speed, 1.0 + motion.breakaway_gain);
    return {level * point.effort + carried, remembers ? 0.0 : level * point.slope};
  }

  /// Viscous part of the friction.
  FrictionPoint viscous(int side, double speed) const {
    const double coefficient = viscosity * drive.curves()[static_cast<std::size_t>(side)].viscous;
    return FrictionPoint{coefficient * speed, coefficient} + further_friction(drive, side, speed);
  }

  double breakaway(int side) const {
    const double gain = drive.dwell_gain > 0.0 ? 1.0 + dwell_gain() : 1.0;
    return level * drive.curves()[static_cast<std::size_t>(side)].breakaway * gain + carried;
  }
  double dwell_gain() const { return drive.dwell_gain * -std::expm1(-motion.rest_s / drive.dwell_time_s); }
  void broke_away() const {
    if (drive.dwell_gain > 0.0) motion.breakaway_gain = dwell_gain();
  }
  void came_to_rest() const { motion.rest_s = 0.0; }
  void rested(double duration_s) const { motion.rest_s += duration_s; }
};

}  // namespace sim
