// Ka from the current, and Kt*Ka from an added inertia, on plants with known gains. Catches a gain that is biased by a
// dead time, a current loop or an offset, and an interval that does not contain the true value.
#include "host/identify/drive_gains.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "host/evidence/measurement_gate.hpp"
#include "host/exit_codes.hpp"
#include "host/hil/simulated_experiment.hpp"
#include "host/identify/excitation.hpp"
#include "host/identify/identification.hpp"
#include "host/identify/paper_drives.hpp"

namespace {

using host::IdentificationMethod;

constexpr double kGain = 6.1, kOffset_A = 0.4, kNoise_A = 0.15;

/// Steps of the paper's x axis with `factor` times the torque per volt and `added` inertia.
host::Record steps(double factor, double added, std::uint64_t seed) {
  sim::DriveDescription drive = *host::paper_drive("x");
  drive.data.torque_constant_Nm_per_A *= factor;
  drive.find("inertia")->parameters["J"] += added;
  return host::record_open_loop(drive, host::doublet_series(10.0 * host::kStepUnit_V, 0.001), seed);
}

/// The current of an amplifier with dead time (samples) and a first-order loop, sampled at each row.
void add_current(host::Record& record, int dead, double loop_s, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, kNoise_A);
  double current = 0.0;
  record.i_A.clear();
  for (std::size_t k = 0; k < record.size(); ++k) {
    record.i_A.push_back(current + kOffset_A + noise(random));
    const double command = k >= static_cast<std::size_t>(dead) ? record.u_V[k - static_cast<std::size_t>(dead)] : 0.0;
    current += (kGain * command - current) * (1.0 - std::exp(-record.sample_period_s / loop_s));
  }
}

TEST(AmplifierGain, IsFoundBehindDeadTimeAndCurrentLoop) {
  int covered = 0;
  constexpr int kTrials = 40;
  for (int trial = 0; trial < kTrials; ++trial) {
    host::Record record = steps(1.0, 0.0, 1);
    add_current(record, trial % 3, 0.0002 * (1 + trial % 2), static_cast<unsigned>(trial));
    const auto found = host::amplifier_gain({record}, 10.0);
    ASSERT_TRUE(found) << trial;
    EXPECT_NEAR(found->gain.value, kGain, 0.005 * kGain) << trial;
    EXPECT_NEAR(found->offset_A, kOffset_A, 0.03) << trial;
    covered += found->gain.ci95[0] <= kGain && kGain <= found->gain.ci95[1];
  }
  std::printf("covered %d of %d\n", covered, kTrials);
  EXPECT_GE(covered, kTrials * 85 / 100);
}

/// Voltage of a winding: the current depends on the voltage and on the speed.
TEST(AmplifierGain, AWindingsVoltageIsNoCommand) {
  host::Record record = steps(1.0, 0.0, 1);
  for (std::size_t k = 0; k < record.size(); ++k) record.i_A.push_back((record.u_V[k] - 0.05 * record.w[k]) / 0.4);
  EXPECT_FALSE(host::amplifier_gain({record}, 10.0));
  record.i_A.clear();
  EXPECT_FALSE(host::amplifier_gain({record}, 10.0)) << "without a current";
}

host::RigidEstimate identified(const host::Record& record) {
  const sim::DriveDescription sheet = host::data_sheet_of(*host::paper_drive("x"));
  return host::identify_drive(host::MeasurementGate(sheet).admit({record}), sheet, IdentificationMethod::sliding_ls)
      .estimate;
}

TEST(GainCheck, AnAddedInertiaShowsTheTorqueConstant) {
  constexpr double kJ = 7.65e-3, kAdded = 4e-3;
  const double assumed = 6.4898 * 0.4769;
  for (const double factor : {0.92, 1.0, 1.08}) {
    const host::RigidEstimate bare = identified(steps(factor, 0.0, 1)), loaded = identified(steps(factor, kAdded, 2));
    const host::GainCheck check = host::check_gain(bare.inertia, loaded.inertia, kAdded, assumed);
    std::printf("true factor %.2f: found %.4f [%.4f, %.4f], J %.6f [%.6f, %.6f]; by the sheet J %.6f\n", factor,
                check.factor.value, check.factor.ci95[0], check.factor.ci95[1], check.inertia.value,
                check.inertia.ci95[0], check.inertia.ci95[1], bare.inertia.value);
    EXPECT_NEAR(check.factor.value, factor, 0.01);
    EXPECT_NEAR(check.found, factor * assumed, 0.01 * assumed);
    EXPECT_NEAR(check.inertia.value, kJ, 0.015 * kJ);
    EXPECT_LE(check.factor.ci95[0], factor);
    EXPECT_GE(check.factor.ci95[1], factor);
    EXPECT_NEAR(bare.inertia.value, kJ / factor, 0.01 * kJ) << "what the data sheet's gain makes of it";
  }
}

TEST(GainCheck, AnInertiaThatDoesNotShowIsRefused) {
  const host::Estimate bare{0.01, {0.0098, 0.0102}}, loaded{0.0101, {0.0099, 0.0103}};
  try {
    host::check_gain(bare, loaded, 1e-4, 3.0);
    FAIL() << "not refused";
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::refused);
  }
}

}  // namespace
