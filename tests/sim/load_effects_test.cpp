// Torques that act on the shaft beside the motor's, each against its closed form.
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
      DriveState state = drive.at(0.0, 0.0);
      for (int k = 0; k < 300; ++k) {
        drive.step(state, 0.0, 0.001 * k, 0.001);
        const double acting_s = std::clamp(0.001 * (k + 1) - start_s, 0.0, duration_s);
        ASSERT_NEAR(state.w, 0.5 / kInertia * acting_s, 1e-9) << k;
      }
    }
}

TEST(LoadTorques, AddUp) {
  const Drive drive(with(with(free_mass(), "constant_torque", {{"torque", 0.3}}), "cogging",
                         {{"cosine", 0.2}, {"sine", 0.0}, {"period", 1e6}}));
  EXPECT_NEAR(run(drive, drive.at(0.0, 0.0), 0.1, 100, 0.001).w, 0.6 / kInertia * 0.1, 1e-9);
}

}  // namespace
