// Two masses on a spring, with and without a gap, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

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

constexpr double kLoadFraction = 0.3;

sim::DriveDescription on_spring(sim::DriveDescription drive, double resonance_Hz, double damping_ratio) {
  return with(std::move(drive), "compliance",
              {{"resonance", resonance_Hz}, {"damping_ratio", damping_ratio}, {"load_fraction", kLoadFraction}});
}

TEST(Compliance, FreeVibrationHasItsFrequencyAndDamping) {
  for (const double resonance_Hz : {25.0, 80.0, 240.0}) {
    const double damping = 0.05;
    const Drive drive(on_spring(free_mass(), resonance_Hz, damping));
    DriveState state = drive.at(0.0, 0.0);
    state.x = 0.7e-3;
    state.load_x = -0.3e-3;
    const double period_s = 0.05 / resonance_Hz;
    std::vector<double> crossings_s, peaks;
    double peak = 0.0;
    for (int k = 0; k < 400; ++k) {
      const double before = state.x - state.load_x;
      drive.step(state, 0.0, 0.0, period_s);
      const double after = state.x - state.load_x;
      peak = std::max(peak, std::abs(after));
      if (before * after < 0.0) {
        crossings_s.push_back((k + before / (before - after)) * period_s);
        peaks.push_back(peak);
        peak = 0.0;
      }
    }
    ASSERT_GT(crossings_s.size(), 15u);
    const double frequency_Hz = 10.0 / 2.0 / (crossings_s[12] - crossings_s[2]);
    EXPECT_NEAR(frequency_Hz, resonance_Hz * std::sqrt(1.0 - damping * damping), 0.01 * resonance_Hz);
    const double decrement = std::log(peaks[2] / peaks[12]) / 10.0;  // of half a period
    EXPECT_NEAR(decrement, M_PI * damping / std::sqrt(1.0 - damping * damping), 0.03 * M_PI * damping);
  }
}

TEST(Compliance, VibrationKeepsTheMomentum) {
  const Drive drive(on_spring(free_mass(), 60.0, 0.02));
  DriveState state = drive.at(0.0, 0.0);
  state.w = 10.0;
  state.load_w = -4.0;
  const double mean = (1.0 - kLoadFraction) * 10.0 + kLoadFraction * -4.0;
  for (int k = 0; k < 2000; ++k) {
    drive.step(state, 0.0, 0.0, 0.001);
    ASSERT_NEAR((1.0 - kLoadFraction) * state.w + kLoadFraction * state.load_w, mean, 1e-9);
  }
  EXPECT_NEAR(state.w, mean, 1e-3) << "the vibration has died away";
}

TEST(Compliance, BothMassesAccelerateTogether) {
  const Drive drive(on_spring(free_mass(), 120.0, 0.3));
  const DriveState state = run(drive, drive.at(0.0, 0.0), 1.0, 300, 0.001);
  EXPECT_NEAR(state.load_w, 1.0 / kInertia * 0.3, 0.01);
  // The spring transmits the torque that accelerates the load.
  const double reduced = kInertia * kLoadFraction * (1.0 - kLoadFraction);
  const double stiffness = reduced * std::pow(2.0 * M_PI * 120.0, 2);
  EXPECT_NEAR((state.x - state.load_x) / kLead, kLoadFraction * 1.0 / stiffness, 1e-3 * kLoadFraction / stiffness);
}

TEST(Compliance, AStuckTableTwistsTheSpringOnly) {
  const Drive drive(on_spring(coulomb_drive(), 60.0, 0.3));
  const DriveState state = run(drive, drive.at(0.0, 0.0), 0.9 * kCoulomb, 2000, 0.001);
  EXPECT_EQ(state.load_w, 0.0);
  const double reduced = kInertia * kLoadFraction * (1.0 - kLoadFraction);
  const double stiffness = reduced * std::pow(2.0 * M_PI * 60.0, 2);
  EXPECT_NEAR(state.x - state.load_x, kLead * 0.9 * kCoulomb / stiffness, 1e-6);
  EXPECT_EQ(drive.encoder(state), state.x) << "the encoder sits on the motor";
}

/// At constant speed the spring carries the load's own friction: separate parts of dry and viscous friction.
TEST(Compliance, CarriesTheLoadsPartOfEachFriction) {
  const double torque = 3.0 * kCoulomb, dry = 0.5, viscous = 0.2;
  const auto twist_with = [&](std::map<std::string, double> parts) {
    parts.insert({{"resonance", 60.0}, {"damping_ratio", 0.3}, {"load_fraction", kLoadFraction}});
    const Drive drive(with(coulomb_drive(), "compliance", parts));
    const DriveState state = run(drive, drive.at(0.0, 0.0), torque, 20000, 0.001);
    EXPECT_NEAR(state.w, (torque - kCoulomb) / sim_test::kViscous, 1e-3);
    return (state.x - state.load_x) / kLead;
  };
  const double stiffness = kInertia * kLoadFraction * (1.0 - kLoadFraction) * std::pow(2.0 * M_PI * 60.0, 2);
  const double fluid = torque - kCoulomb;
  EXPECT_NEAR(twist_with({{"load_friction", dry}, {"load_viscous", viscous}}) * stiffness,
              dry * kCoulomb + viscous * fluid, 1e-3);
  EXPECT_NEAR(twist_with({{"load_friction", dry}}) * stiffness, dry * torque, 1e-3) << "one part for both";
}

sim::DriveDescription with_gap(sim::DriveDescription drive, double gap_mm) {
  return with(std::move(drive), "backlash",
              {{"gap", gap_mm}, {"resonance", 100.0}, {"damping_ratio", 0.1}, {"load_fraction", kLoadFraction}});
}

TEST(Backlash, TheMotorRunsFreeThroughHalfTheGapFromTheMiddle) {
  const double gap_mm = 0.4, torque = 0.5;
  const Drive drive(with_gap(free_mass(), gap_mm));
  const double acceleration = kLead * torque / (kInertia * (1.0 - kLoadFraction));
  DriveState state = drive.at(0.0, 0.0);
  for (int k = 1; state.x < 0.45 * gap_mm; ++k) {
    ASSERT_EQ(state.load_x, 0.0);
    ASSERT_NEAR(state.x, 0.5 * acceleration * std::pow(0.0005 * (k - 1), 2), 1e-9);
    drive.step(state, torque, 0.0, 0.0005);
  }
  state = run(drive, state, torque, 20, 0.0005);
  EXPECT_GT(state.load_w, 0.0) << "hit";
}

TEST(Backlash, ReversalCostsTheGapAndTheSpring) {
  // The motor's travel while the table stays: the gap and twice the twist that the table's friction needs.
  const double gap_mm = 0.2;
  const Drive drive(with_gap(coulomb_drive(), gap_mm));
  DriveState state = run(drive, drive.at(0.0, 0.0), 1.2 * kCoulomb, 1000, 0.001);
  const double forth = state.x - state.load_x;
  state = run(drive, state, -1.2 * kCoulomb, 2000, 0.001);
  const double back = state.x - state.load_x;
  ASSERT_LT(state.load_w, 0.0);
  const double reduced = kInertia * kLoadFraction * (1.0 - kLoadFraction);
  const double stiffness = reduced * std::pow(2.0 * M_PI * 100.0, 2);
  // At constant speed the spring carries the friction of the table, all of the friction that the drive has.
  EXPECT_NEAR(forth - back, gap_mm + 2.0 * kLead * 1.2 * kCoulomb / stiffness, 0.02 * gap_mm);
}

TEST(Backlash, TheContactNeverPulls) {
  const Drive drive(with_gap(free_mass(), 0.1));
  DriveState state = drive.at(0.0, 0.0);
  state.x = 0.051;  // just in contact, motor leaving
  state.w = -5.0;
  double load_w = 0.0;
  for (int k = 0; k < 20; ++k) {
    drive.step(state, 0.0, 0.0, 1e-4);
    if (state.x - state.load_x < -0.05) break;
    ASSERT_GE(state.load_w, load_w - 1e-15) << "pushed forward or not at all";
    load_w = state.load_w;
  }
}

}  // namespace
