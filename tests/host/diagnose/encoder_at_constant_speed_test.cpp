// A carriage at constant speed with an encoder error, which shows in the position but not in the torque.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "host/compare/effort_residual.hpp"
#include "host/diagnose/improvement.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "tests/host/skip_where_instrumented.hpp"

namespace {

constexpr double kSpeed_m_s = 250e-6, kAmplitude_m = 20e-6, kPeriod_m = 250e-6;

sim::DriveDescription carriage() {
  sim::DriveDescription drive;
  drive.name = "carriage";
  drive.data.kind = sim::DriveKind::linear;
  drive.data.force_constant_N_per_V = 0.05;
  drive.data.sample_period_s = 0.01;
  drive.data.dac_limit_V = 10.0;
  drive.data.encoder_resolution = 1e-7;
  drive.effects = {
      {"inertia", {{"J", 5.0}}, {}, {}}, {"viscous", {{"B", 1000.0}}, {}, {}}, {"coulomb", {{"level", 0.0}}, {}, {}}};
  return drive;
}

struct Wave {
  double amplitude_m, period_m;
};

/// The carriage moves at the speed for 5 V. The encoder adds its error, counts and a little noise.
host::Record run(double from_m, double duration_s, bool with_tachometer, unsigned seed,
                 const std::vector<Wave>& waves = {{kAmplitude_m, kPeriod_m}}) {
  std::mt19937 random(seed);
  std::normal_distribution<double> jitter(0.0, 1.0);
  host::Record record;
  record.path = "run-" + std::to_string(seed) + ".csv";
  record.kind = sim::DriveKind::linear;
  record.sample_period_s = 0.01;
  double x = from_m;
  for (double t_s = 0.0; t_s < duration_s; t_s += 0.01) {
    const double u_V = 5.0 + 0.02 * jitter(random), v_m_s = u_V / 5.0 * kSpeed_m_s;
    double reading = x + 5e-8 * jitter(random);
    for (const Wave& wave : waves) reading += wave.amplitude_m * std::sin(2.0 * std::numbers::pi * x / wave.period_m);
    record.t_s.push_back(t_s);
    record.u_V.push_back(u_V);
    record.x.push_back(1e-7 * std::round(reading / 1e-7));
    if (with_tachometer) record.w.push_back(v_m_s + 5e-8 * jitter(random));
    x += v_m_s * 0.01;
  }
  return record;
}

class EncoderAtConstantSpeed : public testing::Test {
 protected:
  sim::DriveDescription drive = carriage();

  host::Measurements measured(bool with_tachometer) const {
    return host::MeasurementGate(drive).admit({run(0.001, 20.0, with_tachometer, 1)},
                                              {run(0.007, 15.0, with_tachometer, 2)});
  }
};

TEST_F(EncoderAtConstantSpeed, IsAmongTheNamesByPositionAlone) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const host::DiagnosisVerdict verdict = host::diagnose(drive, measured(false)).verdict;
  EXPECT_THAT(verdict.effects, testing::Contains("encoder_cyclic_error"));
  for (const std::string& kind : verdict.effects)  // at a single speed, a torque of that period looks the same
    EXPECT_THAT(kind, testing::AnyOf("encoder_cyclic_error", "cogging", "torque_ripple"));
}

TEST_F(EncoderAtConstantSpeed, IsNamedWhereATachometerGivesTheMotion) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const host::Diagnosis diagnosis = host::diagnose(drive, measured(true));
  EXPECT_EQ(diagnosis.verdict.status, host::Status::missing);
  ASSERT_THAT(diagnosis.verdict.effects, testing::ElementsAre("encoder_cyclic_error"));
  const sim::EffectEntry* found = diagnosis.best.find("encoder_cyclic_error");
  ASSERT_NE(found, nullptr);
  EXPECT_NEAR(found->at("period"), kPeriod_m, 0.002 * kPeriod_m);
  EXPECT_NEAR(std::hypot(found->at("cosine"), found->at("sine")), kAmplitude_m, 0.1 * kAmplitude_m);
}

TEST_F(EncoderAtConstantSpeed, FurtherWavesOfItAreFound) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const std::vector<Wave> waves{{kAmplitude_m, kPeriod_m}, {1.6e-6, kPeriod_m / 2.0}, {1.2e-6, kPeriod_m / 3.0}};
  const host::Diagnosis diagnosis = host::diagnose(
      drive,
      host::MeasurementGate(drive).admit({run(0.001, 20.0, true, 1, waves)}, {run(0.007, 15.0, true, 2, waves)}));
  ASSERT_THAT(diagnosis.verdict.effects, testing::ElementsAre("encoder_cyclic_error"));
  for (const Wave& wave : waves) {
    const auto found = std::ranges::find_if(diagnosis.best.effects, [&](const sim::EffectEntry& entry) {
      return entry.kind == "encoder_cyclic_error" && std::abs(entry.at("period") / wave.period_m - 1.0) < 0.01;
    });
    ASSERT_NE(found, diagnosis.best.effects.end()) << wave.period_m;
    EXPECT_NEAR(std::hypot(found->at("cosine"), found->at("sine")), wave.amplitude_m, 0.05 * wave.amplitude_m);
  }
}

TEST_F(EncoderAtConstantSpeed, AModelThatHasTheErrorNeedsNoTorqueForIt) {
  const host::Measurements records = measured(true);
  sim::DriveDescription known = drive;
  known.effects.push_back(
      {"encoder_cyclic_error", {{"cosine", 0.0}, {"sine", kAmplitude_m}, {"period", kPeriod_m}}, {}, {}});
  const auto missing_N = [&](const sim::DriveDescription& model) {
    const host::RecordSet set = host::compare_on(records.training_records(), drive, host::kWindow_s);
    double square = 0.0;
    const host::ResidualSamples samples = host::residual_samples(model, set, 1);
    for (const double missing : samples.missing) square += missing * missing;
    return std::sqrt(square / static_cast<double>(samples.missing.size()));
  };
  EXPECT_LT(missing_N(known), 0.2 * missing_N(drive));
}

}  // namespace
