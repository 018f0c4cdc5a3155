// Comparison by torque or force, on motions whose torque or force is known in closed form.
#include "host/compare/effort_prediction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/diagnose/diagnosis.hpp"
#include "host/fit/model_fit.hpp"

namespace {

constexpr double kGain_N_per_V = 35.0, kMass_kg = 95.0, kViscous_Ns_per_m = 200.0, kCoulomb_N = 20.0;
constexpr double kPeriod_s = 1e-3, kDelay_s = 1.2e-3;

sim::DriveDescription model_with(double delay_s) {
  sim::DriveDescription model;
  model.data.kind = sim::DriveKind::linear;
  model.data.force_constant_N_per_V = kGain_N_per_V;
  model.data.dac_limit_V = 10.0;
  model.data.encoder_resolution = 1e-7;
  model.effects = {{"inertia", {{"J", kMass_kg}}, {}, {}},
                   {"viscous", {{"B", kViscous_Ns_per_m}}, {}, {}},
                   {"coulomb", {{"positive", kCoulomb_N}, {"negative", -kCoulomb_N}}, {}, {}}};
  if (delay_s > 0.0) model.effects.push_back({"input_delay", {{"delay", delay_s}}, {}, {}});
  return model;
}

/// Two superposed strokes; the axis rests before `start_s`.
struct Strokes {
  double start_s;
  static constexpr double kSlow = 2.0 * std::numbers::pi * 0.5, kFast = 2.0 * std::numbers::pi * 4.0;

  double travel_m(double t_s) const {
    const double t = std::max(0.0, t_s - start_s);
    return 0.05 * (1.0 - std::cos(kSlow * t)) + 0.002 * (1.0 - std::cos(kFast * t));
  }
  double force_N(double t_s) const {
    const double t = t_s - start_s;
    if (t <= 0.0) return 0.0;
    const double v = 0.05 * kSlow * std::sin(kSlow * t) + 0.002 * kFast * std::sin(kFast * t);
    const double a = 0.05 * kSlow * kSlow * std::cos(kSlow * t) + 0.002 * kFast * kFast * std::cos(kFast * t);
    return kMass_kg * a + kViscous_Ns_per_m * v + (v > 0.0 ? kCoulomb_N : -kCoulomb_N);
  }
};

/// The command for these strokes, earlier by the dead time and by half a period of the hold.
host::Record record_of(const Strokes& strokes) {
  host::Record record;
  record.path = "strokes.csv";
  record.kind = sim::DriveKind::linear;
  record.sample_period_s = kPeriod_s;
  for (int k = 0; k < 8000; ++k) {
    const double t_s = k * kPeriod_s;
    record.t_s.push_back(t_s);
    record.x.push_back(1e-7 * std::round(1e7 * strokes.travel_m(t_s)));
    record.u_V.push_back(strokes.force_N(t_s + kDelay_s + 0.5 * kPeriod_s) / kGain_N_per_V);
  }
  return record;
}

host::RecordSet by_effort(const host::Record& record, const sim::DriveDescription& model) {
  return host::compare_on({&record}, model, host::rough_window_s({&record}), host::Measure::effort);
}

TEST(EffortPrediction, KnowsTheForceOfAMotionAndWhenItsCommandWasSent) {
  const host::Record record = record_of({0.0});
  const sim::DriveDescription right = model_with(kDelay_s);
  const host::RecordSet set = by_effort(record, right);
  const double with = host::error_of(sim::Drive(right), set).combined;
  const double without = host::error_of(sim::Drive(model_with(0.0)), set).combined;
  EXPECT_LT(with, 0.2 * without);
  // The residual of the correct model is at reversals, where the force jumps. Half of the windows contain no reversal.
  std::vector<double> squares;
  for (const host::WindowScore& score : host::error_of(sim::Drive(right), set).windows) squares.push_back(score.effort);
  std::ranges::nth_element(squares, squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2));
  EXPECT_LT(std::sqrt(squares[squares.size() / 2]) * set.records.front().effort->floor, 0.02 * kCoulomb_N);
}

TEST(EffortPrediction, AFitFindsTheDeadTime) {
  const host::Record record = record_of({0.0});
  const sim::DriveDescription start = model_with(0.4e-3);
  const host::FitResult fit = host::fit_model(start, by_effort(record, start));
  EXPECT_NEAR(fit.model.find("input_delay")->at("delay"), kDelay_s, 0.05e-3);
  EXPECT_NEAR(fit.model.find("inertia")->at("J"), kMass_kg, 0.005 * kMass_kg);
  EXPECT_NEAR(fit.model.find("coulomb")->at("positive"), kCoulomb_N, 0.02 * kCoulomb_N);
}

TEST(EffortPrediction, StandstillIsNotJudged) {
  const host::Record record = record_of({3.0});
  const host::RecordSet set = by_effort(record, model_with(0.0));
  EXPECT_FALSE(set.records.front().prepared.windows.empty());
  for (const host::Window& window : set.records.front().prepared.windows)
    EXPECT_GE(static_cast<double>(window.begin) * kPeriod_s, 2.9);
}

TEST(EffortPrediction, AModelThatRemembersIsJudgedByItsMotion) {
  const host::Record record = record_of({0.0});
  sim::DriveDescription model = model_with(0.0);
  EXPECT_EQ(host::rough_measure(model, {&record}, {}), host::Measure::effort);
  model.effects.push_back({"presliding", {{"sigma0", 1e6}, {"sigma1", 1e3}}, {}, {}});
  EXPECT_EQ(host::rough_measure(model, {&record}, {}), host::Measure::motion);
}

}  // namespace
