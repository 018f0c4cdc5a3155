// Inertia with viscous, Coulomb and Stribeck friction, against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/sim/small_drive.hpp"

namespace {

using sim::Drive;
using sim::DriveState;
using sim_test::coulomb_drive;
using sim_test::entry;
using sim_test::free_mass;
using sim_test::kCoulomb;
using sim_test::kInertia;
using sim_test::kLead;
using sim_test::kOmega;
using sim_test::kRate;
using sim_test::kStatic;
using sim_test::kViscous;
using sim_test::run;
using sim_test::stribeck_drive;
using sim_test::viscous_drive;
using sim_test::with;

TEST(LinearDrive, StepResponseIsExactForAnyStep) {
  const Drive drive(viscous_drive());
  const double u_V = 1.3, w0 = -7.0, x0 = 12.0, end_s = 0.48;
  const double w_settled = u_V / kViscous;
  const double fading = std::exp(-kRate * end_s);
  const double w = w_settled + (w0 - w_settled) * fading;
  const double x = x0 + kLead * (w_settled * end_s + (w0 - w_settled) * (1.0 - fading) / kRate);
  for (const int steps : {1, 6, 480}) {
    const DriveState state = run(drive, drive.at(x0, w0), u_V, steps, end_s / steps);
    EXPECT_NEAR(state.w, w, 1e-9 * w_settled) << steps;
    EXPECT_NEAR(state.x, x, 1e-9 * kLead * w_settled) << steps;
  }
}

TEST(LinearDrive, WithoutFrictionTheMotionIsAParabola) {
  const Drive drive(free_mass());
  const double u_V = -2.0, w0 = 3.0, end_s = 0.25, acceleration = u_V / kInertia;
  const DriveState state = run(drive, drive.at(0.0, w0), u_V, 250, 0.001);
  EXPECT_NEAR(state.w, w0 + acceleration * end_s, 1e-11);
  EXPECT_NEAR(state.x, kLead * (w0 * end_s + 0.5 * acceleration * end_s * end_s), 1e-11);
}

TEST(CoulombFriction, CoastDownStopsAtTheRightInstantAndPlace) {
  const Drive drive(coulomb_drive());
  for (const double w0 : {30.0, -30.0}) {
    const double speed = std::abs(w0), settled = kCoulomb / kViscous;
    const double stop_s = std::log1p(speed / settled) / kRate;
    const double distance = kLead * (speed / kRate - settled * stop_s);
    // Also with one step far beyond the stop: the instant is found inside the step.
    for (const double period_s : {0.001, 0.037, 2.0}) {
      DriveState state = drive.at(5.0, w0);
      double t_s = 0.0;
      while (state.w != 0.0 && t_s < 3.0) drive.step(state, 0.0, t_s, period_s), t_s += period_s;
      EXPECT_EQ(state.w, 0.0);
      EXPECT_EQ(std::ceil(stop_s / period_s - 1e-9), std::round(t_s / period_s)) << "first sample after the stop";
      EXPECT_NEAR(state.x, 5.0 + std::copysign(distance, w0), 1e-9 * distance) << period_s;
    }
  }
}

TEST(CoulombFriction, AReversalInsideAStepIsExact) {
  const Drive drive(coulomb_drive());
  // From +2 rad/s under -1.1 Nm: braked by friction and command until the stop, then driven back against friction.
  const double w0 = 2.0, u_V = -1.1, period_s = 0.05;
  const double braking = (kCoulomb - u_V) / kViscous, driving = (-u_V - kCoulomb) / kViscous;
  const double stop_s = std::log1p(w0 / braking) / kRate, back_s = period_s - stop_s;
  ASSERT_GT(back_s, 0.0);
  const double w = -driving * (1.0 - std::exp(-kRate * back_s));
  const double forth = w0 / kRate - braking * stop_s;
  const double back = driving * (back_s - (1.0 - std::exp(-kRate * back_s)) / kRate);
  const DriveState state = run(drive, drive.at(0.0, w0), u_V, 1, period_s);
  EXPECT_NEAR(state.w, w, 1e-10);
  EXPECT_NEAR(state.x, kLead * (forth - back), 1e-10);
}

TEST(CoulombFriction, BelowItsLevelTheDriveSticksExactly) {
  const Drive drive(coulomb_drive());
  for (const double u_V : {0.0, 0.999 * kCoulomb, -0.999 * kCoulomb}) {
    const DriveState state = run(drive, drive.at(3.25, 0.0), u_V, 1000, 0.001);
    EXPECT_EQ(state.w, 0.0);
    EXPECT_EQ(state.x, 3.25);
    EXPECT_EQ(drive.tachometer(state), 0.0);
  }
  for (const double u_V : {1.001 * kCoulomb, -1.001 * kCoulomb}) {
    const DriveState state = run(drive, drive.at(3.25, 0.0), u_V, 1, 0.001);
    EXPECT_GT(state.w * u_V, 0.0);
  }
}

/// The first command of a slow ramp that moves the drive.
double breakaway_V(const Drive& drive, double sign) {
  DriveState state = drive.at(0.0, 0.0);
  for (int k = 0; k < 20000; ++k) {
    const double u_V = sign * 1e-4 * k;
    drive.step(state, u_V, 0.001 * k, 0.001);
    if (state.w != 0.0) return u_V;
  }
  return 0.0;
}

TEST(Breakaway, CoulombLevelPerDirection) {
  const Drive drive(with(viscous_drive(), "coulomb", {{"positive", 0.45}, {"negative", -0.25}}));
  EXPECT_NEAR(breakaway_V(drive, 1.0), 0.45, 1.001e-4);
  EXPECT_NEAR(breakaway_V(drive, -1.0), -0.25, 1.001e-4);
}

TEST(Breakaway, StaticFrictionPerDirection) {
  const Drive drive(with(coulomb_drive(), "stribeck",
                         {{"static_positive", 0.9}, {"static_negative", -0.6}, {"omega1", 2.0}, {"omega2", 2.0}}));
  EXPECT_NEAR(breakaway_V(drive, 1.0), 0.9, 1.001e-4);
  EXPECT_NEAR(breakaway_V(drive, -1.0), -0.6, 1.001e-4);
}

TEST(Stribeck, SteadySpeedBalancesTheCurve) {
  // Eq. (19): the command that holds a speed; different velocity constants, so that both terms are seen.
  const double omega1 = 2.0, omega2 = 5.0;
  const Drive drive(with(coulomb_drive(), "stribeck", {{"static", kStatic}, {"omega1", omega1}, {"omega2", omega2}}));
  for (const double w : {4.0, 8.0, 20.0, -6.0}) {
    const double speed = std::abs(w);
    const double friction =
        kStatic * std::exp(-speed / omega1) + kCoulomb * (1.0 - std::exp(-speed / omega2)) + kViscous * speed;
    const DriveState state = run(drive, drive.at(0.0, 1.2 * w), std::copysign(friction, w), 20000, 0.001);
    EXPECT_NEAR(state.w, w, 1e-6) << w;
  }
}

TEST(Stribeck, WithoutVelocityConstantsFrictionFallsToTheCoulombLevelAtOnce) {
  const Drive drive(with(coulomb_drive(), "stribeck", {{"static", kStatic}, {"omega1", 0.0}, {"omega2", 0.0}}));
  EXPECT_EQ(run(drive, drive.at(0.0, 0.0), 0.999 * kStatic, 10, 0.001).w, 0.0);
  const double u_V = 1.001 * kStatic;
  const DriveState state = run(drive, drive.at(0.0, 0.0), u_V, 100, 0.001);
  EXPECT_NEAR(state.w, (u_V - kCoulomb) / kViscous * (1.0 - std::exp(-kRate * 0.1)), 1e-9);
}

/// Speed under eq. (19) from `w0` > 0, by a classical Runge-Kutta rule of order 4 at 1 us: error about 1e-12.
double stribeck_reference(double w0, double u_V, double end_s) {
  const auto rate = [u_V](double w) {
    const double fading = std::exp(-w / kOmega);
    return (u_V - kStatic * fading - kCoulomb * (1.0 - fading) - kViscous * w) / kInertia;
  };
  const double h = 1e-6;
  double w = w0;
  for (int k = 0, n = static_cast<int>(std::lround(end_s / h)); k < n; ++k) {
    const double a = rate(w), b = rate(w + 0.5 * h * a), c = rate(w + 0.5 * h * b), d = rate(w + h * c);
    w += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
  }
  return w;
}

TEST(TimeStepRefinement, StribeckConvergesWithOrderTwo) {
  const Drive drive(stribeck_drive());
  const double w0 = 0.5, u_V = 0.8, end_s = 0.064;
  const double exact = stribeck_reference(w0, u_V, end_s);
  std::vector<double> errors;
  for (const int steps : {16, 32, 64, 128, 256})
    errors.push_back(std::abs(run(drive, drive.at(0.0, w0), u_V, steps, end_s / steps).w - exact));
  for (std::size_t k = 1; k < errors.size(); ++k) {
    const double order = std::log2(errors[k - 1] / errors[k]);
    EXPECT_NEAR(order, 2.0, 0.15) << "halving " << k << ", error " << errors[k];
  }
  EXPECT_LT(errors[2], 1e-3 * exact) << "at 1 ms";
}

TEST(TimeStepRefinement, CoulombAndViscousFrictionNeedNone) {
  const Drive drive(coulomb_drive());
  const DriveState coarse = run(drive, drive.at(0.0, 9.0), -0.9, 1, 0.64);
  const DriveState fine = run(drive, drive.at(0.0, 9.0), -0.9, 4096, 0.64 / 4096);
  EXPECT_LT(coarse.w, 0.0) << "through a reversal";
  EXPECT_NEAR(coarse.w, fine.w, 1e-9);
  EXPECT_NEAR(coarse.x, fine.x, 1e-9);
}

TEST(Stribeck, StopsInsideAStep) {
  const Drive drive(stribeck_drive());
  // The stopping time from the reference solution, by halving the interval.
  double early = 0.0, late = 0.2;
  for (int k = 0; k < 20; ++k) {
    const double middle = 0.5 * (early + late);
    (stribeck_reference(3.0, 0.0, middle) > 0.0 ? early : late) = middle;
  }
  DriveState state = drive.at(0.0, 3.0);
  const double period_s = 0.0005;
  int steps = 0;
  while (state.w != 0.0 && steps < 1000) drive.step(state, 0.0, 0.0, period_s), ++steps;
  EXPECT_EQ(steps, static_cast<int>(std::ceil(early / period_s)));
  const double at_stop = state.x;
  drive.step(state, 0.0, 0.0, 1.0);
  EXPECT_EQ(state.x, at_stop);
  EXPECT_EQ(state.w, 0.0);
}

TEST(LinearKind, ForceMassAndMetres) {
  sim::DriveDescription axis;
  axis.data.kind = sim::DriveKind::linear;
  axis.data.force_constant_N_per_V = 35.0;
  axis.effects = {entry("inertia", {{"J", 95.0}}), entry("viscous", {{"B", 200.0}}),
                  entry("coulomb", {{"level", 20.0}})};
  const Drive drive(axis);
  const double settled = (35.0 * 3.0 - 20.0) / 200.0, rate = 200.0 / 95.0, end_s = 0.5;
  const DriveState state = run(drive, drive.at(0.0, 0.0), 3.0, 500, 0.001);
  EXPECT_NEAR(state.w, settled * (1.0 - std::exp(-rate * end_s)), 1e-10);
  EXPECT_NEAR(state.x, settled * (end_s - (1.0 - std::exp(-rate * end_s)) / rate), 1e-10);
}

}  // namespace
