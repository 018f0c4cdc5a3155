// Effects between the command and the shaft, each against its closed form.
#include <gtest/gtest.h>

#include <array>
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
using sim_test::kNmPerAmpere;
using sim_test::kRate;
using sim_test::kViscous;
using sim_test::run;
using sim_test::viscous_drive;
using sim_test::with;

/// Speed of the viscous drive at `t_s`, from rest, if a torque of `effort` acts from `start_s` on.
double step_response(double effort, double start_s, double t_s) {
  return t_s <= start_s ? 0.0 : effort / kViscous * (1.0 - std::exp(-kRate * (t_s - start_s)));
}

TEST(InputDelay, ShiftsEveryCommandByExactlyItsTime) {
  // Less than a period, whole periods, and periods with a remainder.
  for (const double delay_s : {0.0004, 0.001, 0.003, 0.0034, 0.025}) {
    const Drive drive(with(viscous_drive(), "input_delay", {{"delay", delay_s}}));
    DriveState state = drive.at(0.0, 0.0);
    for (int k = 0; k < 80; ++k) {
      const double u_V = k < 20 ? 1.0 : (k < 45 ? -2.0 : 0.5);
      drive.step(state, u_V, 0.001 * k, 0.001);
      const double t_s = 0.001 * (k + 1);
      const double w = step_response(1.0, delay_s, t_s) + step_response(-3.0, 0.020 + delay_s, t_s) +
                       step_response(2.5, 0.045 + delay_s, t_s);
      ASSERT_NEAR(state.w, w, 1e-9) << "delay " << delay_s << ", t " << t_s;
    }
  }
}

TEST(InputDelay, BeyondTheMemoryTimeStillRunsAtItsOwnPace) {
  // 0.1 ms a step: the drive remembers fewer commands than the dead time asks for.
  const Drive drive(with(free_mass(), "input_delay", {{"delay", 0.025}}));
  DriveState state = drive.at(0.0, 4.0);
  state = run(drive, state, 0.0, 1000, 0.0001);
  EXPECT_NEAR(state.x, kLead * 4.0 * 0.1, 1e-9);
}

TEST(CurrentLoopLag, StepResponse) {
  const double tau_s = 1.0 / (2.0 * M_PI * 40.0), u_V = 1.7, end_s = 0.02;
  const Drive drive(with(free_mass(), "current_loop_lag", {{"bandwidth", 40.0}}));
  const double fading = 1.0 - std::exp(-end_s / tau_s);
  const double w = u_V / kInertia * (end_s - tau_s * fading);
  const double x = kLead * u_V / kInertia * (0.5 * end_s * end_s - tau_s * end_s + tau_s * tau_s * fading);
  std::array<double, 2> x_error{};
  for (const int halving : {0, 1}) {
    const int steps = 20 << halving;
    const DriveState state = run(drive, drive.at(0.0, 0.0), u_V, steps, end_s / steps);
    EXPECT_NEAR(state.w, w, 1e-9 * w);
    EXPECT_NEAR(state.effort, u_V * fading, 1e-9);
    x_error[static_cast<std::size_t>(halving)] = std::abs(state.x - x);
  }
  EXPECT_NEAR(std::log2(x_error[0] / x_error[1]), 2.0, 0.1) << "the travel converges with order 2";
}

TEST(CurrentSaturation, ClipsTheTorque) {
  const Drive drive(with(viscous_drive(), "current_saturation", {{"limit", 3.0}}));
  const double limit_Nm = 3.0 * kNmPerAmpere;
  for (const double u_V : {1.0, 1.5, 4.0, 10.0, -4.0}) {
    const double effort = std::copysign(std::min(std::abs(u_V), limit_Nm), u_V);
    EXPECT_NEAR(run(drive, drive.at(0.0, 0.0), u_V, 100, 0.001).w, step_response(effort, 0.0, 0.1), 1e-9) << u_V;
  }
}

TEST(VoltageLimit, TorqueFallsWithSpeedWhileMotoring) {
  const double stall = 2.0, no_load = 40.0, end_s = 0.1;
  const Drive drive(with(free_mass(), "voltage_limit", {{"stall", stall}, {"no_load_speed", no_load}}));
  for (const double u_V : {10.0, -10.0}) {
    const double w = std::copysign(no_load * (1.0 - std::exp(-stall / no_load / kInertia * end_s)), u_V);
    const double at_1ms = run(drive, drive.at(0.0, 0.0), u_V, 100, end_s / 100).w - w;
    const double at_half_ms = run(drive, drive.at(0.0, 0.0), u_V, 200, end_s / 200).w - w;
    EXPECT_LT(std::abs(at_1ms), 1e-4 * no_load);
    EXPECT_NEAR(std::log2(at_1ms / at_half_ms), 2.0, 0.1);
  }
}

TEST(VoltageLimit, LeavesBrakingAndSmallTorqueAlone) {
  const Drive drive(with(free_mass(), "voltage_limit", {{"stall", 2.0}, {"no_load_speed", 40.0}}));
  EXPECT_NEAR(run(drive, drive.at(0.0, 30.0), -1.9, 50, 0.001).w, 30.0 - 1.9 / kInertia * 0.05, 1e-9);
  EXPECT_NEAR(run(drive, drive.at(0.0, 10.0), 1.0, 50, 0.001).w, 10.0 + 1.0 / kInertia * 0.05, 1e-9);
}

TEST(DacDeadZone, SwallowsSmallCommandsAndShortensLargeOnes) {
  const Drive drive(with(viscous_drive(), "dac_dead_zone", {{"width", 0.2}}));
  for (const double u_V : {0.0, 0.2, -0.2, 0.1}) EXPECT_EQ(run(drive, drive.at(0.0, 0.0), u_V, 100, 0.001).w, 0.0);
  EXPECT_NEAR(run(drive, drive.at(0.0, 0.0), 1.0, 100, 0.001).w, step_response(0.8, 0.0, 0.1), 1e-9);
  EXPECT_NEAR(run(drive, drive.at(0.0, 0.0), -1.0, 100, 0.001).w, step_response(-0.8, 0.0, 0.1), 1e-9);
}

TEST(DacOffset, MovesTheDriveAtZeroCommand) {
  const Drive drive(with(viscous_drive(), "dac_offset", {{"offset", -0.3}}));
  EXPECT_NEAR(run(drive, drive.at(0.0, 0.0), 0.0, 100, 0.001).w, step_response(-0.3, 0.0, 0.1), 1e-9);
  EXPECT_EQ(run(drive, drive.at(0.0, 0.0), 0.3, 100, 0.001).w, 0.0);
}

TEST(DacOffset, AndDeadZoneActInTheOrderOfTheModel) {
  const auto offset_first =
      with(with(viscous_drive(), "dac_offset", {{"offset", 0.3}}), "dac_dead_zone", {{"width", 0.2}});
  const Drive drive(offset_first);
  EXPECT_NEAR(run(drive, drive.at(0.0, 0.0), 0.0, 100, 0.001).w, step_response(0.1, 0.0, 0.1), 1e-9);
}

TEST(TorqueRipple, ScalesTheMotorTorqueAlongTheTravel) {
  const double period_mm = 8.0;
  const Drive drive(with(coulomb_drive(), "torque_ripple", {{"cosine", 0.2}, {"sine", -0.1}, {"period", period_mm}}));
  for (const double x : {0.0, 1.0, 2.0, 5.5}) {
    const double angle = 2.0 * M_PI * x / period_mm;
    const double breakaway_V = kCoulomb / (1.0 + 0.2 * std::cos(angle) - 0.1 * std::sin(angle));
    EXPECT_EQ(run(drive, drive.at(x, 0.0), 0.9999 * breakaway_V, 5, 0.001).w, 0.0) << x;
    EXPECT_GT(run(drive, drive.at(x, 0.0), 1.0001 * breakaway_V, 5, 0.001).w, 0.0) << x;
  }
}

TEST(TorqueRipple, IsAbsentWithoutCurrent) {
  const Drive drive(with(viscous_drive(), "torque_ripple", {{"cosine", 0.2}, {"sine", 0.2}, {"period", 8.0}}));
  EXPECT_NEAR(run(drive, drive.at(0.0, 50.0), 0.0, 100, 0.001).w, 50.0 * std::exp(-kRate * 0.1), 1e-9);
}

TEST(TorqueRipple, WorkOverAPeriodIsThatOfTheMeanTorque) {
  const double period_mm = 3.0, u_V = 1.0;
  const Drive drive(with(free_mass(), "torque_ripple", {{"cosine", 0.3}, {"sine", 0.4}, {"period", period_mm}}));
  DriveState state = drive.at(0.0, 20.0);
  double before_x = 0.0, before_w = 0.0;
  while (state.x < 10.0 * period_mm) {
    before_x = state.x, before_w = state.w;
    drive.step(state, u_V, 0.0, 1e-4);
  }
  const double share = (10.0 * period_mm - before_x) / (state.x - before_x);
  const double w = before_w + share * (state.w - before_w);
  EXPECT_NEAR(0.5 * kInertia * (w * w - 400.0), u_V * 10.0 * period_mm / kLead, 2e-3 * u_V * 10.0 * period_mm / kLead);
}

}  // namespace
