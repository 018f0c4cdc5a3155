// Errors of encoder and tachometer, each against its closed form.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/small_drive.hpp"

namespace {

using sim::Drive;
using sim::DriveState;
using sim_test::coulomb_drive;
using sim_test::free_mass;
using sim_test::kInertia;
using sim_test::kLead;
using sim_test::run;
using sim_test::with;

TEST(TachGain, MultipliesTheReading) {
  const Drive drive(with(free_mass(), "tach_gain", {{"gain", 0.98}}));
  const DriveState state = run(drive, drive.at(0.0, 25.0), 0.0, 10, 0.001);
  EXPECT_DOUBLE_EQ(drive.tachometer(state), 0.98 * 25.0);
  EXPECT_NEAR(state.x, kLead * 25.0 * 0.01, 1e-12) << "the effect does not change the motion";
}

TEST(TachOffset, IsReadAtStandstill) {
  const Drive drive(with(coulomb_drive(), "tach_offset", {{"offset", -0.4}}));
  EXPECT_DOUBLE_EQ(drive.tachometer(drive.at(0.0, 0.0)), -0.4);
  EXPECT_DOUBLE_EQ(drive.tachometer(drive.at(0.0, 5.0)), 4.6);
}

TEST(TachLag, TrailsARampByItsTimeConstant) {
  const double tau_s = 1.0 / (2.0 * M_PI * 30.0), acceleration = 2.0 / kInertia;
  const Drive drive(with(free_mass(), "tach_lag", {{"bandwidth", 30.0}}));
  DriveState state = drive.at(0.0, 0.0);
  for (int k = 1; k <= 100; ++k) {
    drive.step(state, 2.0, 0.0, 0.001);
    const double t_s = 0.001 * k;
    ASSERT_NEAR(drive.tachometer(state), acceleration * (t_s - tau_s * (1.0 - std::exp(-t_s / tau_s))), 1e-9) << k;
  }
}

TEST(TachRipple, IsProportionalToSpeedAndPeriodicInTravel) {
  const double period_mm = 10.0;
  const Drive drive(with(free_mass(), "tach_ripple", {{"cosine", 0.02}, {"sine", 0.03}, {"period", period_mm}}));
  for (const double x : {0.0, 1.3, 11.3, 26.0})
    for (const double w : {0.0, 2.0, -40.0}) {
      const double angle = 2.0 * M_PI * x / period_mm;
      EXPECT_NEAR(drive.tachometer(drive.at(x, w)), w * (1.0 + 0.02 * std::cos(angle) + 0.03 * std::sin(angle)), 1e-12);
    }
}

TEST(EncoderCyclicError, AddsToTheTravelThatIsRead) {
  const double period_mm = 4.0;
  const Drive drive(
      with(free_mass(), "encoder_cyclic_error", {{"cosine", 0.003}, {"sine", -0.004}, {"period", period_mm}}));
  for (const double x : {0.0, 0.9, 3.0, -7.7}) {
    const double angle = 2.0 * M_PI * x / period_mm;
    EXPECT_NEAR(drive.encoder(drive.at(x, 3.0)), x + 0.003 * std::cos(angle) - 0.004 * std::sin(angle), 1e-12);
  }
  EXPECT_NEAR(run(drive, drive.at(1.0, 3.0), 0.0, 10, 0.001).x, 1.0 + kLead * 3.0 * 0.01, 1e-12);
}

TEST(EncoderCyclicError, HarmonicsAddUp) {
  const auto once = with(free_mass(), "encoder_cyclic_error", {{"cosine", 0.003}, {"sine", 0.0}, {"period", 4.0}});
  const Drive drive(with(once, "encoder_cyclic_error", {{"cosine", 0.0}, {"sine", 0.005}, {"period", 1.0}}));
  EXPECT_NEAR(drive.encoder(drive.at(2.25, 0.0)), 2.25 + 0.003 * std::cos(M_PI * 1.125) + 0.005, 1e-12);
}

}  // namespace
