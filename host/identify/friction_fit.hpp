// The friction curve (19) through points of friction against speed.
#pragma once

#include <array>
#include <vector>

#include "host/identify/friction_law.hpp"
#include "host/identify/rigid_estimate.hpp"

namespace host {

/// Mean friction torque or force at one speed, both with their sign. Speeds in rad/s or m/s, torque or force in Nm or
/// N.
struct CurvePoint {
  double speed = 0.0;
  double effort = 0.0;          ///< includes the viscous part
  double standard_error = 0.0;  ///< standard error of `effort`
};

/// A fitted curve. Levels are magnitudes; [0] forward, [1] backward.
struct FrictionFit {
  FrictionLaw law;
  bool has_stribeck = false;  ///< false if the points show no static friction above the Coulomb level or are too few
  Estimate viscous;
  std::array<Estimate, 2> coulomb{}, static_level{}, omega1{}, omega2{};  ///< interval (value, value) if unknown
  double rms = 0.0;                                                       ///< RMS of the residuals, Nm or N
};

/// Section 3.2 of the paper, eqs. (53)-(62), from the points of the Kalman disturbance (they include the viscous part
/// of the observer's B): slope of the fast points, their mean as Coulomb level, the slowest point as static level,
/// omega1 and omega2 by a grid of 0 to 10 rad/s in steps of 0.1 (in proportion for other top speeds). "Fast" is above a
/// quarter of the top speed; the grid uses points above a hundredth of it, as in the paper's set of eleven. Points of
/// one speed and direction are averaged first. No intervals. Throws Failure(refused) if a direction has fewer than two
/// fast speeds or fewer than four speeds.
FrictionFit fit_friction_as_paper(const std::vector<CurvePoint>& points, double observer_viscous);

/// One weighted least-squares fit of B' and, per direction, T_coul, T_stat, omega1, omega2 (`symmetric`: one set for
/// both). The weight of a point comes from its standard error. Intervals use Student's t and are widened if the scatter
/// exceeds these errors. The Stribeck part needs five speeds in each direction, and is kept only if the Bayesian
/// information criterion prefers it. Throws Failure(refused) if a direction has fewer than two speeds.
FrictionFit fit_friction(const std::vector<CurvePoint>& points, bool symmetric);

}  // namespace host
