// Friction effects, each against its closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "tests/sim/small_drive.hpp"

namespace {

using sim::Drive;
using sim::DriveState;
using sim_test::coulomb_drive;
using sim_test::free_mass;
using sim_test::kCoulomb;
using sim_test::kInertia;
using sim_test::kLead;
using sim_test::kOmega;
using sim_test::kStatic;
using sim_test::kViscous;
using sim_test::run;
using sim_test::stribeck_drive;
using sim_test::viscous_drive;
using sim_test::with;

/// Sticks at `u_V` just below `level` and moves just above it, in the direction of `level`.
void expect_breakaway(const Drive& drive, const DriveState& rest, double level, double t_s = 0.0) {
  EXPECT_EQ(run(drive, rest, level * (1.0 - 1e-5), 1, 1e-5, t_s).w, 0.0) << level;
  EXPECT_GT(run(drive, rest, level * (1.0 + 1e-5), 1, 1e-5, t_s).w * level, 0.0) << level;
}

TEST(CoulombAsymmetry, OneLevelPerDirection) {
  const auto level = with(free_mass(), "coulomb", {{"level", kCoulomb}});
  const Drive drive(with(level, "coulomb_asymmetry", {{"asymmetry", 0.15}}));
  expect_breakaway(drive, drive.at(0.0, 0.0), 1.15 * kCoulomb);
  expect_breakaway(drive, drive.at(0.0, 0.0), -0.85 * kCoulomb);
  EXPECT_NEAR(run(drive, drive.at(0.0, 10.0), 0.0, 100, 0.001).w, 10.0 - 1.15 * kCoulomb / kInertia * 0.1, 1e-9);
  EXPECT_NEAR(run(drive, drive.at(0.0, -10.0), 0.0, 100, 0.001).w, -10.0 + 0.85 * kCoulomb / kInertia * 0.1, 1e-9);
}

TEST(CoulombAsymmetry, StaticFrictionAlike) {
  const Drive drive(with(stribeck_drive(), "coulomb_asymmetry", {{"asymmetry", -0.2}}));
  expect_breakaway(drive, drive.at(0.0, 0.0), 0.8 * kStatic);
  expect_breakaway(drive, drive.at(0.0, 0.0), -1.2 * kStatic);
}

TEST(ViscousAsymmetry, OneRatePerDirection) {
  const Drive drive(with(viscous_drive(), "viscous_asymmetry", {{"asymmetry", 0.3}}));
  const double rate = kViscous / kInertia;
  EXPECT_NEAR(run(drive, drive.at(0.0, 20.0), 0.0, 200, 0.001).w, 20.0 * std::exp(-1.3 * rate * 0.2), 1e-9);
  EXPECT_NEAR(run(drive, drive.at(0.0, -20.0), 0.0, 200, 0.001).w, -20.0 * std::exp(-0.7 * rate * 0.2), 1e-9);
}

TEST(NonlinearViscous, SteadySpeedBalancesTheCurve) {
  for (const double exponent : {0.4, 1.0, 2.0})
    for (const double w : {3.0, -25.0}) {
      const Drive drive(with(coulomb_drive(), "nonlinear_viscous", {{"coefficient", 0.2}, {"exponent", exponent}}));
      const double friction = kCoulomb + kViscous * std::abs(w) + 0.2 * std::pow(std::abs(w) / 10.0, exponent);
      const DriveState state = run(drive, drive.at(0.0, 0.9 * w), std::copysign(friction, w), 8000, 0.001);
      EXPECT_NEAR(state.w, w, 1e-6) << exponent;
    }
}

TEST(NonlinearViscous, QuadraticDragSlowsHyperbolically) {
  const Drive drive(with(free_mass(), "nonlinear_viscous", {{"coefficient", 0.2}, {"exponent", 2.0}}));
  const double w0 = 60.0, end_s = 0.2;
  const double w = w0 / (1.0 + w0 * 0.2 / (100.0 * kInertia) * end_s);
  const double at_1ms = run(drive, drive.at(0.0, w0), 0.0, 200, end_s / 200).w - w;
  const double at_half_ms = run(drive, drive.at(0.0, w0), 0.0, 400, end_s / 400).w - w;
  EXPECT_LT(std::abs(at_1ms), 1e-3 * w);
  EXPECT_NEAR(std::log2(at_1ms / at_half_ms), 2.0, 0.15);
}

TEST(NonlinearViscous, StartsFromRestUnderARootLaw) {
  // J dw/dt = T - c sqrt(w/10): with q = sqrt(w), a = T/J, b = c/(J sqrt(10)):
  // t = -(2/b) (q + (a/b) ln(1 - q b/a)).
  const double torque = 0.5, c = 0.2, a = torque / kInertia, b = c / kInertia / std::sqrt(10.0);
  const Drive drive(with(free_mass(), "nonlinear_viscous", {{"coefficient", c}, {"exponent", 0.5}}));
  const double w = 1.0, q = std::sqrt(w);
  const double end_s = -2.0 / b * (q + a / b * std::log1p(-q * b / a));
  const double period_s = end_s / std::round(end_s / 0.001);
  const int steps = static_cast<int>(std::lround(end_s / period_s));
  EXPECT_NEAR(run(drive, drive.at(0.0, 0.0), torque, steps, period_s).w, w, 0.01 * w);
}

TEST(Presliding, TravelBeforeSlipFollowsTheBristle) {
  // Loaded slowly, LuGre with a constant level g obeys dz/dtheta = 1 - sigma0 z/g: theta = -(g/sigma0) ln(1 - T/g).
  const double sigma0 = 800.0, g = kCoulomb;
  const Drive drive(with(coulomb_drive(), "presliding", {{"sigma0", sigma0}, {"sigma1", 2.0}}));
  DriveState state = drive.at(0.0, 0.0);
  const double most = 0.8 * g, ramp_s = 4.0;
  for (int k = 0; k < 4000; ++k) {
    const double torque = most * (k + 0.5) / 4000.0;
    drive.step(state, torque, 0.0, ramp_s / 4000.0);
    if (k % 1000 == 999) {
      const double carried = most * (k + 1) / 4000.0;
      const double x = -kLead * g / sigma0 * std::log1p(-carried / g);
      EXPECT_NEAR(state.x, x, 0.02 * x) << carried;
      EXPECT_NEAR(sigma0 * state.bristle, carried, 0.01 * carried);
    }
  }
}

TEST(Presliding, AMassSwingsOnItsBristlesAsOnASpring) {
  // The longest steps, half a radian: a simple scheme of order 2 would have the wrong phase after twenty radians.
  const double sigma0 = 2500.0, sigma1 = 0.2, z0 = 1e-7;
  const Drive drive(with(coulomb_drive(), "presliding", {{"sigma0", sigma0}, {"sigma1", sigma1}}));
  const double omega = std::sqrt(sigma0 / kInertia), fading = 0.5 * (sigma1 + kViscous) / kInertia;
  const double swings = std::sqrt(omega * omega - fading * fading);
  DriveState state = drive.at(0.0, 0.0);
  state.bristle = z0;
  for (int k = 1; k <= 50; ++k) {
    drive.step(state, 0.0, 0.0, 0.001);
    const double t_s = 0.001 * k;
    const double z = z0 * std::exp(-fading * t_s) * (std::cos(swings * t_s) + fading / swings * std::sin(swings * t_s));
    ASSERT_NEAR(state.bristle, z, 0.03 * z0) << k;
  }
}

TEST(Presliding, UnloadingReturnsTheElasticPartOnly) {
  const double sigma0 = 800.0, g = kCoulomb;
  const Drive drive(with(coulomb_drive(), "presliding", {{"sigma0", sigma0}, {"sigma1", 2.0}}));
  const DriveState loaded = run(drive, drive.at(0.0, 0.0), 0.6 * g, 2000, 0.001);
  const DriveState unloaded = run(drive, loaded, 0.0, 2000, 0.001);
  // Back against the motion: dz/dtheta = 1 + sigma0 z/g, theta = (g/sigma0) ln(1 + T/g).
  EXPECT_NEAR(loaded.x - unloaded.x, kLead * g / sigma0 * std::log1p(0.6), 0.02 * kLead * g / sigma0);
  EXPECT_GT(unloaded.x, 0.0);
}

TEST(Presliding, SteadyFrictionIsTheCurve) {
  const Drive drive(with(stribeck_drive(), "presliding", {{"sigma0", 800.0}, {"sigma1", 2.0}}));
  for (const double w : {6.0, -15.0}) {
    const double fading = std::exp(-std::abs(w) / kOmega);
    const double friction = kStatic * fading + kCoulomb * (1.0 - fading) + kViscous * std::abs(w);
    const DriveState state = run(drive, drive.at(0.0, w), std::copysign(friction, w), 5000, 0.001);
    EXPECT_NEAR(state.w, w, 1e-3 * std::abs(w));
  }
}

TEST(Presliding, FollowingASlideFindsTheFrictionThatActs) {
  // Sliding bends the bristle by g/sigma0, whatever changes g, even if the torque is known only to 3 %.
  const double sigma0 = 800.0, w = 0.05, warm = -0.3, asymmetry = 0.2, late_s = 1e3;
  const sim::DriveDescription plain = with(coulomb_drive(), "presliding", {{"sigma0", sigma0}, {"sigma1", 0.5}});
  const sim::DriveDescription drifting = with(
      plain, "thermal_friction_drift", {{"coulomb_change", warm}, {"viscous_change", 0.0}, {"time_constant", 10.0}});
  const sim::DriveDescription uneven = with(plain, "coulomb_asymmetry", {{"asymmetry", asymmetry}});
  for (const auto& [description, g] :
       {std::pair(plain, kCoulomb), {drifting, (1.0 + warm) * kCoulomb}, {uneven, (1.0 + asymmetry) * kCoulomb}}) {
    const Drive drive(description);
    DriveState state = drive.at(0.0, w);
    for (int k = 0; k < 1000; ++k)
      drive.follow(state, 0.97 * (g + kViscous * w), state.x + 0.001 * kLead * w, w, late_s + 0.001 * k, 0.001);
    EXPECT_NEAR(sigma0 * state.bristle, g, 1e-3 * g);
  }
}

TEST(FrictionLag, FrictionFollowsASpeedJumpWithItsTimeConstant) {
  // A flywheel so heavy that its speed is constant; the impulse of friction after a jump from 1 to 6 rad/s.
  const double heavy = 1e4, tau_s = 0.03, before = 1.0, after = 6.0, end_s = 0.06;
  sim::DriveDescription description = stribeck_drive();
  description.effects.front().parameters["J"] = heavy;
  const Drive drive(with(description, "friction_lag", {{"time", tau_s}}));
  DriveState state = drive.at(0.0, before);
  state.w = after;
  double impulse = 0.0;  // by the midpoint rule at 1 us
  for (int k = 0; k < 60000; ++k) {
    const double speed = after + (before - after) * std::exp(-(k + 0.5) * 1e-6 / tau_s);
    const double fading = std::exp(-speed / kOmega);
    impulse += 1e-6 * (kStatic * fading + kCoulomb * (1.0 - fading) + kViscous * after);
  }
  const DriveState end = run(drive, state, 0.0, 60, end_s / 60);
  EXPECT_NEAR(heavy * (after - end.w), impulse, 5e-3 * impulse);
  EXPECT_NEAR(end.friction_speed, after + (before - after) * std::exp(-end_s / tau_s), 1e-3);
}

TEST(DwellStiction, BreakawayGrowsWithTheRest) {
  const double gain = 0.4, tau_s = 2.0;
  const Drive drive(with(stribeck_drive(), "dwell_stiction", {{"gain", gain}, {"time_constant", tau_s}}));
  for (const double rest_s : {0.1, 1.0, 4.0, 30.0}) {
    const DriveState rested = run(drive, drive.at(0.0, 0.0), 0.3, static_cast<int>(rest_s / 0.01 + 0.5), 0.01);
    const double level = kStatic * (1.0 + gain * (1.0 - std::exp(-rest_s / tau_s)));
    expect_breakaway(drive, rested, level);
    expect_breakaway(drive, rested, -level);
  }
}

TEST(DwellStiction, HoldsATorqueAfterTheRestThatItNeeds) {
  const double gain = 0.4, tau_s = 2.0;
  const Drive drive(with(stribeck_drive(), "dwell_stiction", {{"gain", gain}, {"time_constant", tau_s}}));
  for (const double sign : {1.0, -1.0}) {
    const auto rest_to_hold = [&](double torque) { return drive.rest_to_hold(drive.at(0.0, 0.0), sign * torque, 0.0); };
    EXPECT_EQ(rest_to_hold(0.99 * kStatic), 0.0);
    EXPECT_NEAR(rest_to_hold(kStatic * (1.0 + gain * (1.0 - std::exp(-0.7 / tau_s)))), 0.7, 1e-9);
    EXPECT_EQ(rest_to_hold(1.41 * kStatic), HUGE_VAL);
  }
}

TEST(DwellStiction, FollowingAMotionSeesThatTheRestIsForgottenBesideADrag) {
  // During creep after a rest, friction is at the level without the increase by the rest, because an undetected short
  // stop has ended this increase. An additional drag of the same size must not be mistaken for the increase.
  const double gain = 0.4, w = 0.2, fading = std::exp(-w / kOmega), drag = gain * kStatic * fading;
  const Drive drive(with(with(stribeck_drive(), "dwell_stiction", {{"gain", gain}, {"time_constant", 0.5}}),
                         "nonlinear_viscous", {{"coefficient", drag * std::sqrt(10.0 / w)}, {"exponent", 0.5}}));
  const double without = kStatic * fading + kCoulomb * (1.0 - fading) + kViscous * w + drag;
  for (const bool keeps : {true, false}) {
    DriveState state = drive.at(0.0, 0.0);
    for (int k = 0; k < 5000; ++k) drive.follow(state, 0.0, 0.0, 0.0, 0.001 * k, 0.001);
    for (int k = 0; k < 300; ++k)
      drive.follow(state, without + (keeps ? drag : 0.0), state.x + 0.001 * kLead * w, w, 5.0 + 0.001 * k, 0.001);
    EXPECT_NEAR(state.breakaway_gain, keeps ? gain : 0.0, 1e-3);
  }
}

sim::DriveDescription two_masses_with_dwell(double load_friction) {
  return with(with(stribeck_drive(), "dwell_stiction", {{"gain", 0.4}, {"time_constant", 2.0}}), "compliance",
              {{"resonance", 60.0},
               {"damping_ratio", 0.02},
               {"load_fraction", 0.4},
               {"load_friction", load_friction},
               {"load_viscous", 0.0}});
}

TEST(DwellStiction, OfTwoMassesRestsWhileTheLoadSwings) {
  for (const double load_friction : {0.0, 0.4, 1.0}) {
    const Drive drive(two_masses_with_dwell(load_friction));
    DriveState state = drive.at(0.0, 0.0);
    if (load_friction < 0.5) state.load_w = 0.1;  // its force remains below breakaway
    EXPECT_NEAR(run(drive, state, 0.0, 3000, 0.001).rest_s, 3.0, 0.01) << load_friction;
  }
}

TEST(DwellStiction, OfTwoMassesIsSeenWhileFollowingARest) {
  const Drive drive(two_masses_with_dwell(0.0));
  DriveState state = drive.at(0.0, 0.0);
  for (int k = 0; k < 3000; ++k) drive.follow(state, 0.1, k % 2 * 0.001, 0.0, 0.001 * k, 0.001);
  EXPECT_NEAR(state.rest_s, 3.0, 0.01);
  EXPECT_NEAR(state.breakaway_gain, 0.4 * (1.0 - std::exp(-1.5)), 1e-3);
}

TEST(DwellStiction, IsGoneAfterAMotion) {
  const Drive drive(with(stribeck_drive(), "dwell_stiction", {{"gain", 0.4}, {"time_constant", 2.0}}));
  DriveState state = run(drive, drive.at(0.0, 0.0), 0.0, 1000, 0.01);
  state = run(drive, state, 2.0, 50, 0.001);
  ASSERT_GT(state.w, 0.0);
  // Brakes to a stop under a command that does not break away again.
  int steps = 0;
  while (state.w != 0.0 && ++steps < 1000) drive.step(state, -0.9 * kStatic, 0.0, 0.001);
  ASSERT_EQ(state.w, 0.0);
  const double rest_s = state.rest_s;
  EXPECT_LT(rest_s, 0.001);
  expect_breakaway(drive, state, -kStatic * (1.0 + 0.4 * (1.0 - std::exp(-rest_s / 2.0))));
}

TEST(PositionDependentFriction, BreakawayFollowsTheTravel) {
  const double period_mm = 200.0;
  const Drive drive(
      with(coulomb_drive(), "position_dependent_friction", {{"cosine", 0.2}, {"sine", -0.1}, {"period", period_mm}}));
  for (const double x : {0.0, 30.0, 125.0}) {
    const double angle = 2.0 * M_PI * x / period_mm;
    const double level = kCoulomb * (1.0 + 0.2 * std::cos(angle) - 0.1 * std::sin(angle));
    expect_breakaway(drive, drive.at(x, 0.0), level);
    expect_breakaway(drive, drive.at(x, 0.0), -level);
  }
}

TEST(PositionDependentFriction, CoastDownSpendsTheKineticEnergyOnIt) {
  const double period_mm = 20.0, cosine = 0.4, w0 = 25.0;
  const auto level = with(free_mass(), "coulomb", {{"level", kCoulomb}});
  const Drive drive(
      with(level, "position_dependent_friction", {{"cosine", cosine}, {"sine", 0.0}, {"period", period_mm}}));
  const DriveState state = run(drive, drive.at(0.0, w0), 0.0, 2000, 0.001);
  ASSERT_EQ(state.w, 0.0);
  const double wavenumber = 2.0 * M_PI / period_mm;
  const double work = kCoulomb / kLead * (state.x + cosine / wavenumber * std::sin(wavenumber * state.x));
  EXPECT_NEAR(work, 0.5 * kInertia * w0 * w0, 1e-3 * work);
}

TEST(ThermalFrictionDrift, LevelAndViscosityFollowTheTime) {
  const double tau_s = 10.0, b = -0.4, c = 0.25;
  const std::map<std::string, double> drift = {{"viscous_change", b}, {"coulomb_change", c}, {"time_constant", tau_s}};
  const Drive drive(with(coulomb_drive(), "thermal_friction_drift", drift));
  for (const double t_s : {0.0, 5.0, 60.0})
    expect_breakaway(drive, drive.at(0.0, 0.0), kCoulomb * (1.0 + c * (1.0 - std::exp(-t_s / tau_s))), t_s);
  // Without Coulomb friction: ln(w0/w) = (B/J) (t + b (t - tau (1 - exp(-t/tau)))).
  const Drive oil(with(viscous_drive(), "thermal_friction_drift", drift));
  const double end_s = 1.0;
  const double decay = kViscous / kInertia * (end_s + b * (end_s - tau_s * (1.0 - std::exp(-end_s / tau_s))));
  EXPECT_NEAR(std::log(50.0 / run(oil, oil.at(0.0, 50.0), 0.0, 1000, 0.001).w), decay, 1e-4 * decay);
}

TEST(ThermalFrictionDrift, CountsFromTheColdStart) {
  const double tau_s = 10.0, c = 0.25, start_s = 1.7e9;  // as in a log whose clock counts from 1970
  const Drive drive(
      with(coulomb_drive(), "thermal_friction_drift",
           {{"viscous_change", 0.0}, {"coulomb_change", c}, {"time_constant", tau_s}, {"cold_start", start_s}}));
  for (const double t_s : {0.0, 5.0, 60.0})
    expect_breakaway(drive, drive.at(0.0, 0.0), kCoulomb * (1.0 + c * (1.0 - std::exp(-t_s / tau_s))), start_s + t_s);
}

TEST(LoadDependentFriction, TakesItsShareOfTheMotorTorque) {
  const double share = 0.1;
  const auto level = with(free_mass(), "coulomb", {{"level", kCoulomb}});
  const Drive drive(with(level, "load_dependent_friction", {{"coefficient", share}}));
  expect_breakaway(drive, drive.at(0.0, 0.0), kCoulomb / (1.0 - share));
  const double motoring = (2.0 * (1.0 - share) - kCoulomb) / kInertia;
  const double braking = (2.0 * (1.0 + share) + kCoulomb) / kInertia;
  EXPECT_NEAR(run(drive, drive.at(0.0, 30.0), 2.0, 50, 0.001).w, 30.0 + motoring * 0.05, 1e-9);
  EXPECT_NEAR(run(drive, drive.at(0.0, 30.0), -2.0, 50, 0.001).w, 30.0 - braking * 0.05, 1e-9);
}

}  // namespace
