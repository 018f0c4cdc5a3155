// Torques on the shaft in addition to the motor's, each against its closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/sim/small_drive.hpp"

namespace {

using sim::Drive;
using sim::DriveState;
using sim_test::coulomb_drive;
using sim_test::free_mass;
using sim_test::kCoulomb;
using sim_test::kInertia;
using sim_test::kLead;
using sim_test::run;
using sim_test::with;

TEST(ConstantTorque, AcceleratesAndShiftsBothBreakawayLevels) {
  const Drive falling(with(free_mass(), "constant_torque", {{"torque", -0.3}}));
  EXPECT_NEAR(run(falling, falling.at(0.0, 0.0), 0.0, 100, 0.001).w, -0.3 / kInertia * 0.1, 1e-10);
  const Drive drive(with(coulomb_drive(), "constant_torque", {{"torque", -0.3}}));
  for (const double u_V : {kCoulomb + 0.3 - 1e-6, 0.3 - kCoulomb + 1e-6})
    EXPECT_EQ(run(drive, drive.at(0.0, 0.0), u_V, 10, 0.001).w, 0.0) << u_V;
  EXPECT_GT(run(drive, drive.at(0.0, 0.0), kCoulomb + 0.3 + 1e-6, 10, 0.001).w, 0.0);
  EXPECT_LT(run(drive, drive.at(0.0, 0.0), 0.3 - kCoulomb - 1e-6, 10, 0.001).w, 0.0);
}

TEST(SpringTorque, OscillatesAtItsNaturalFrequency) {
  const double stiffness = 4.0, centre = 2.0, amplitude = 1.5;  // Nm/mm, mm, mm
  const double omega = std::sqrt(stiffness * kLead / kInertia);
  const Drive drive(with(free_mass(), "spring_torque", {{"stiffness", stiffness}, {"centre", centre}}));
  const double end_s = 2.3 * 2.0 * M_PI / omega;
  const auto error = [&](int steps) {
    const DriveState state = run(drive, drive.at(centre + amplitude, 0.0), 0.0, steps, end_s / steps);
    return std::hypot(state.x - centre - amplitude * std::cos(omega * end_s),
                      state.w * kLead / omega + amplitude * std::sin(omega * end_s));
  };
  EXPECT_LT(error(600), 1e-3 * amplitude) << "1 ms";
  EXPECT_NEAR(std::log2(error(600) / error(1200)), 2.0, 0.1);
}

TEST(Cogging, ShiftsTheBreakawayLevelAlongTheTravel) {
  const double period_mm = 6.0;
  const Drive drive(with(coulomb_drive(), "cogging", {{"cosine", 0.10}, {"sine", 0.15}, {"period", period_mm}}));
  for (const double x : {0.0, 0.7, 2.0, 4.4}) {
    const double angle = 2.0 * M_PI * x / period_mm;
    const double cogging = 0.10 * std::cos(angle) + 0.15 * std::sin(angle);
    EXPECT_EQ(run(drive, drive.at(x, 0.0), kCoulomb - cogging - 1e-6, 5, 0.001).w, 0.0) << x;
    EXPECT_GT(run(drive, drive.at(x, 0.0), kCoulomb - cogging + 1e-6, 5, 0.001).w, 0.0) << x;
    EXPECT_LT(run(drive, drive.at(x, 0.0), -kCoulomb - cogging - 1e-6, 5, 0.001).w, 0.0) << x;
  }
}

// If an order is read as a separate period, or loses its number, breakaway occurs at another position.
TEST(Cogging, OfSeveralOrdersIsTheSumOfThem) {
  const double period_mm = 6.0;
  const Drive drive(with(coulomb_drive(), "cogging",
                         {{"cosine", 0.05},
                          {"sine", 0.0},
                          {"cosine_3", 0.0},
                          {"sine_3", 0.10},
                          {"cosine_12", 0.04},
                          {"sine_12", 0.02},
                          {"period", period_mm}}));
  EXPECT_DOUBLE_EQ(drive.finest_period, period_mm / 12.0);
  for (const double x : {0.0, 0.7, 2.0, 4.4}) {
    const double angle = 2.0 * M_PI * x / period_mm;
    const double cogging = 0.05 * std::cos(angle) + 0.10 * std::sin(3.0 * angle) + 0.04 * std::cos(12.0 * angle) +
                           0.02 * std::sin(12.0 * angle);
    EXPECT_EQ(run(drive, drive.at(x, 0.0), kCoulomb - cogging - 1e-6, 5, 0.001).w, 0.0) << x;
    EXPECT_GT(run(drive, drive.at(x, 0.0), kCoulomb - cogging + 1e-6, 5, 0.001).w, 0.0) << x;
  }
}

sim::DriveDescription with_curve(sim::DriveDescription drive, std::string over, std::map<std::string, double> points) {
  drive = with(std::move(drive), "free_curve", std::move(points));
  drive.effects.back().over = std::move(over);
  return drive;
}

TEST(FreeCurve, OverSpeedIsFrictionWithALevelOfItsOwnInEachDirection) {
  // Forward 0.2 Nm at 10 rad/s, backward 0.1 Nm; a drive of that speed and effort keeps it.
  const auto drive = Drive(with_curve(
      free_mass(), "speed",
      {{"knot_0", -20.0}, {"value_0", -0.1}, {"knot_1", 0.0}, {"value_1", 0.0}, {"knot_2", 20.0}, {"value_2", 0.4}}));
  EXPECT_NEAR(run(drive, drive.at(0.0, 10.0), 0.2, 200, 0.001).w, 10.0, 1e-9);
  EXPECT_NEAR(run(drive, drive.at(0.0, -10.0), -0.05, 200, 0.001).w, -10.0, 1e-9);
  EXPECT_LT(run(drive, drive.at(0.0, 10.0), 0.0, 10, 0.001).w, 10.0) << "passive";
}

TEST(FreeCurve, OverPositionIsWhatTheMotorMustGiveThere) {
  const auto drive = Drive(
      with_curve(coulomb_drive(), "position", {{"knot_0", 0.0}, {"value_0", 0.0}, {"knot_1", 10.0}, {"value_1", 0.5}}));
  EXPECT_EQ(run(drive, drive.at(4.0, 0.0), kCoulomb + 0.2 - 1e-6, 5, 0.001).w, 0.0);
  EXPECT_GT(run(drive, drive.at(4.0, 0.0), kCoulomb + 0.2 + 1e-6, 5, 0.001).w, 0.0);
}

TEST(FreeCurve, FrictionAlongThePositionHoldsBothWays) {
  const auto drive = Drive(with_curve(coulomb_drive(), "friction_along_position",
                                      {{"knot_0", 0.0}, {"value_0", 0.0}, {"knot_1", 10.0}, {"value_1", 0.5}}));
  for (const double way : {-1.0, 1.0}) {
    EXPECT_EQ(run(drive, drive.at(4.0, 0.0), way * (kCoulomb + 0.2 - 1e-6), 5, 0.001).w, 0.0);
    EXPECT_GT(way * run(drive, drive.at(4.0, 0.0), way * (kCoulomb + 0.2 + 1e-6), 5, 0.001).w, 0.0);
  }
}

TEST(FreeCurve, FrictionOverTimeHoldsBothWaysAndChangesWithIt) {
  const auto drive = Drive(with_curve(coulomb_drive(), "friction_over_time",
                                      {{"knot_0", 0.0}, {"value_0", 0.0}, {"knot_1", 10.0}, {"value_1", 0.5}}));
  for (const double way : {-1.0, 1.0})
    for (const double t_s : {0.0, 4.0, 20.0}) {
      const double level = kCoulomb + 0.05 * std::min(t_s, 10.0);
      sim::DriveState state = drive.at(0.0, 0.0);
      drive.step(state, way * (level - 1e-6), t_s, 0.001);
      EXPECT_EQ(state.w, 0.0) << t_s;
      drive.step(state, way * (level + 1e-6), t_s, 0.001);
      EXPECT_GT(way * state.w, 0.0) << t_s;
    }
}

TEST(FreeCurve, OverPhaseComesBackWithItsPeriod) {
  const auto drive = Drive(with_curve(
      coulomb_drive(), "phase",
      {{"knot_0", 0.0}, {"value_0", 0.0}, {"knot_1", 1.0}, {"value_1", 0.5}, {"knot_2", 2.0}, {"value_2", 0.0}}));
  for (const double x : {-3.0, 1.0, 41.0}) {
    EXPECT_EQ(run(drive, drive.at(x, 0.0), kCoulomb + 0.5 - 1e-6, 5, 0.001).w, 0.0) << x;
    EXPECT_GT(run(drive, drive.at(x, 0.0), kCoulomb + 0.5 + 1e-6, 5, 0.001).w, 0.0) << x;
  }
  EXPECT_GT(run(drive, drive.at(40.0, 0.0), kCoulomb + 1e-6, 5, 0.001).w, 0.0);
}

TEST(FreeCurve, OverTravelSinceReversalBeginsAnewWhenTheMotionTurns) {
  const auto drive = Drive(with_curve(coulomb_drive(), "travel_since_reversal",
                                      {{"knot_0", 0.0}, {"value_0", 0.0}, {"knot_1", 1.0}, {"value_1", 0.3}}));
  const DriveState far = run(drive, drive.at(0.0, 1.0), 2.0, 100, 0.001);
  ASSERT_GT(far.x, 1.0);
  EXPECT_EQ(far.heading, 1.0);
  const DriveState back = run(drive, far, -4.0, 300, 0.001);
  ASSERT_LT(back.w, 0.0);
  EXPECT_EQ(back.heading, -1.0);
  EXPECT_GT(back.turned_x, far.x);
}

TEST(Cogging, IsConservative) {
  // Kinetic energy and the integral of the torque along the travel; at a speed that crosses several periods a sample.
  const double cosine = 0.2, sine = 0.1, period_mm = 2.0, wavenumber = 2.0 * M_PI / period_mm;
  const Drive drive(with(free_mass(), "cogging", {{"cosine", cosine}, {"sine", sine}, {"period", period_mm}}));
  for (const double w0 : {12.0, 100.0, 400.0}) {
    const auto energy = [&](const DriveState& state) {
      return 0.5 * kInertia * state.w * state.w -
             (cosine * std::sin(wavenumber * state.x) - sine * std::cos(wavenumber * state.x)) / wavenumber / kLead;
    };
    DriveState state = drive.at(0.0, w0);
    const double start = energy(state);
    const double swing = std::hypot(cosine, sine) / wavenumber / kLead;
    for (int k = 0; k < 2000; ++k) {
      drive.step(state, 0.0, 0.001 * k, 0.001);
      ASSERT_NEAR(energy(state), start, 0.1 * swing) << "w0 " << w0 << ", step " << k;
    }
  }
}

TEST(ExternalTorque, ActsInItsStretchOfTimeOnly) {
  // Edges on the samples and between them; a torque shorter than a sample.
  for (const double start_s : {0.1, 0.1003})
    for (const double duration_s : {0.05, 0.0126, 0.0004}) {
      const Drive drive(
          with(free_mass(), "external_torque", {{"torque", 0.5}, {"start", start_s}, {"duration", duration_s}}));
      constexpr double kSpeed = 1.0;
      DriveState state = drive.at(0.0, kSpeed);
      for (int k = 0; k < 300; ++k) {
        drive.step(state, 0.0, 0.001 * k, 0.001);
        const double acting_s = std::clamp(0.001 * (k + 1) - start_s, 0.0, duration_s);
        ASSERT_NEAR(state.w, kSpeed + 0.5 / kInertia * acting_s, 1e-9) << k;
      }
    }
}

/// Catches a force that drives an axis at rest through its screw, or helps its motor to break it away; one that a motor
/// at rest does not have to overcome; one that a linear drive does not feel; one that drives a stopped axis back.
TEST(ExternalTorque, IsFeltInMotionOnlyBehindAScrew) {
  constexpr double kLarge = 3.0 * kCoulomb;
  const auto pushed = [&](double torque) {
    return Drive(with(coulomb_drive(), "external_torque", {{"torque", torque}, {"start", 0.0}, {"duration", 9.0}}));
  };
  for (const double way : {1.0, -1.0}) {
    const Drive helping = pushed(way * kLarge), opposing = pushed(-way * kLarge);
    EXPECT_EQ(run(helping, helping.at(0.0, 0.0), 0.0, 100, 0.001).x, 0.0);
    EXPECT_EQ(run(helping, helping.at(0.0, 0.0), way * 0.9 * kCoulomb, 100, 0.001).x, 0.0);
    EXPECT_EQ(run(opposing, opposing.at(0.0, 0.0), way * 0.9 * (kLarge + kCoulomb), 100, 0.001).x, 0.0);
    EXPECT_GT(way * run(opposing, opposing.at(0.0, 0.0), way * 1.1 * (kLarge + kCoulomb), 100, 0.001).x, 0.0);
    // In motion the whole force acts: it stops the axis, and does not drive it back.
    const DriveState slowed = run(opposing, opposing.at(0.0, way * 10.0), 0.0, 1, 0.001);
    EXPECT_NEAR(way * (way * 10.0 - slowed.w), 0.001 / kInertia * (kLarge + kCoulomb + 10.0 * sim_test::kViscous),
                5e-3);
    const DriveState stopped = run(opposing, opposing.at(0.0, way * 1.0), 0.0, 100, 0.001);
    EXPECT_EQ(stopped.w, 0.0);
  }
  sim::DriveDescription direct;
  direct.data.kind = sim::DriveKind::linear;
  direct.data.force_constant_N_per_V = 1.0;
  direct.effects = {sim_test::entry("inertia", {{"J", 2.0}}),
                    sim_test::entry("external_torque", {{"torque", 1.0}, {"start", 0.0}, {"duration", 9.0}})};
  const Drive linear(direct);
  EXPECT_NEAR(run(linear, linear.at(0.0, 0.0), 0.0, 100, 0.001).w, 0.05, 1e-9);
}

TEST(LoadTorques, AddUp) {
  const Drive drive(with(with(free_mass(), "constant_torque", {{"torque", 0.3}}), "cogging",
                         {{"cosine", 0.2}, {"sine", 0.0}, {"period", 1e6}}));
  EXPECT_NEAR(run(drive, drive.at(0.0, 0.0), 0.1, 100, 0.001).w, 0.6 / kInertia * 0.1, 1e-9);
}

}  // namespace
