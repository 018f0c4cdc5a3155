// The noise stated for the rows of a force balance, compared with the noise caused by an encoder's steps.
#include "host/effort/effort_rows.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "host/fit/prepared_sets.hpp"
#include "tests/host/effort/made_effort.hpp"

namespace {

/// Forward and backward for a second each with ramps in between, at a given number of encoder steps per sample.
Point steady_strokes(double t_s, double w) {
  constexpr double kRamp_s = 0.1, kStroke_s = 1.0, kHalf_s = kRamp_s + kStroke_s;
  const double whole = std::floor(t_s / kHalf_s), phase = t_s - whole * kHalf_s;
  const double sign = std::fmod(whole, 2.0) == 0.0 ? 1.0 : -1.0, bend = kTurn / 2.0 / kRamp_s;
  // A ramp from -w to w as half a cosine. The travel over both halves is zero.
  const double start = sign > 0.0 ? 0.0 : w * kStroke_s;
  if (phase < kRamp_s)
    return {start - sign * w / bend * std::sin(bend * phase), -sign * w * std::cos(bend * phase),
            sign * w * bend * std::sin(bend * phase)};
  return {start + sign * w * (phase - kRamp_s), sign * w, 0.0};
}

/// RMS torque due to errors of the acceleration at steady speed, over the noise stated for the rows.
double noise_over_stated(double steps_a_sample) {
  const sim::DriveDescription model = motor();
  const double w = steps_a_sample * model.data.encoder_resolution / 1e-3;
  const auto motion = [w](double t_s) { return steady_strokes(t_s, w); };
  const auto none = [](const Point&) { return 0.0; };
  host::Record records[] = {record_of(motion, none, 0.0, 20.0, 1, 0.0), record_of(motion, none, 0.0, 20.0, 2, 0.0)};
  const host::PreparedSets sets = host::split_sets(model, {&records[0]}, {&records[1]});
  const host::EffortRows rows = host::effort_rows(model, sets.training, sets.validation);
  double squares = 0.0, count = 0.0;
  for (Eigen::Index k = 0; k < rows.acceleration.size(); ++k) {
    const double phase = std::fmod(rows.t_s(k), 1.1);
    if (phase < 0.2 || phase > 1.0) continue;  // the filter includes the ramps
    squares += std::pow(model.find("inertia")->at("J") * rows.acceleration(k), 2);
    count += 1.0;
  }
  EXPECT_GT(count, 1000.0);
  return std::sqrt(squares / count) / rows.noise;
}

TEST(EffortRows, StateTheNoiseOfStepsThatRepeat) {
  for (const double steps : {10.05, 10.37, 7.02}) {
    EXPECT_LT(noise_over_stated(steps), 1.2) << steps;
  }
  EXPECT_GT(noise_over_stated(10.05), 0.5);
}

}  // namespace
