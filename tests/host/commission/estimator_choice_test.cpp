// The choice by hand, and the noise of a command that is made of known parts.
#include "host/commission/estimator_choice.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

host::TrackingTest tested(double variance, double error_um, double noise_V, double um_per_N, double repeats_um = 0.0) {
  host::TrackingTest test;
  test.disturbance_variance = variance;
  test.error_um = error_um;
  test.noise_V = noise_V;
  test.compliance.um_per_N = um_per_N;
  test.repeats_um = repeats_um;
  return test;
}

/// Noise grows as compliance falls, and the following error grows with the noise.
std::vector<host::TrackingTest> usual() {
  return {tested(1e-4, 0.65, 0.02, 0.032), tested(1e-3, 0.70, 0.06, 0.013), tested(1e-2, 0.80, 0.16, 0.005),
          tested(1e-1, 0.84, 0.40, 0.0019), tested(1.0, 0.94, 0.82, 0.001)};
}

/// Catches a calm value that follows best but yields more to process forces than the axis did before.
TEST(EstimatorChoice, IsNoSofterThanTheFirst) {
  const auto choice = host::choose_estimator(usual(), {{0.005, 30.0}, {}, 1.0});
  ASSERT_TRUE(choice.value);
  EXPECT_EQ(*choice.value, 2u);
  EXPECT_NE(choice.why.find("0.001 V² makes the axis 160 % softer than the first estimator"), std::string::npos)
      << choice.why;
  EXPECT_NE(choice.why.find("0.1 V² deviates 5 % more with 150 % more noise of the command"), std::string::npos)
      << choice.why;
  // Softer by less than one step of the bandwidth.
  EXPECT_EQ(host::choose_estimator(usual(), {{0.0123, 30.0}, {}, 1.0}).value, 1u);
  EXPECT_EQ(host::choose_estimator(usual(), {{0.0115, 30.0}, {}, 1.0}).value, 2u);
  EXPECT_FALSE(host::choose_estimator(usual(), {{1e-4, 30.0}, {}, 1.0}).value);
}

/// Deviations under 20 N, by hand: sqrt(0.65^2 + 0.452^2) = 0.792, sqrt(0.70^2 + 0.184^2) = 0.724, 0.803; under 100 N:
/// 2.354, 1.156, 0.875, 0.851, 0.943; under 1000 N: 22.6, 9.2, 3.62, 1.585, 1.176.
TEST(EstimatorChoice, DeviatesLeastUnderTheForce) {
  for (const auto& [force_N, place] : {std::pair{20.0, 1u}, {100.0, 3u}, {1000.0, 4u}})
    EXPECT_EQ(host::choose_estimator(usual(), {{0.005, 30.0}, force_N, 1.0}).value, place) << force_N;
  EXPECT_NEAR(host::deviation_um(0.65, {0.032, 10.0}, 20.0), 0.792, 5e-4);
  EXPECT_EQ(host::deviation_um(0.65, {0.032, 10.0}, {}), 0.65);
}

/// Catches noise that takes the command into saturation for the sake of stiffness.
TEST(EstimatorChoice, LeavesRoomForTheCommand) {
  const auto choice = host::choose_estimator(usual(), {{0.005, 30.0}, 1000.0, 0.5});
  EXPECT_EQ(choice.value, 3u);
  EXPECT_NE(choice.why.find("1 V² makes 0.82 V of noise, and the limits leave room for 0.5 V"), std::string::npos)
      << choice.why;
}

/// Catches a larger value that is taken although it deviates less by no more than equal runs differ.
TEST(EstimatorChoice, IsCalmWhereNoiseBuysNothing) {
  const auto choice = host::choose_estimator(
      {tested(1e-4, 5.0, 0.01, 0.1, 0.3), tested(1e-3, 4.8, 0.03, 0.01, 0.3), tested(1e-2, 7.0, 0.1, 1e-3, 0.1)},
      {{1.0, 30.0}, {}, 1.0});
  EXPECT_EQ(choice.value, 0u);
}

/// Catches a value that was never run, whose figures are zero.
TEST(EstimatorChoice, IsOfWhatWasRun) {
  host::TrackingTest stopped = tested(1e-1, 0.0, 0.0, 0.0);
  stopped.unusable_because = "the loop oscillates";
  EXPECT_EQ(host::choose_estimator({tested(1e-3, 5.0, 0.02, 0.1), stopped}, {{1.0, 30.0}, {}, 1.0}).value, 0u);
  EXPECT_FALSE(host::choose_estimator({stopped}, {{1.0, 30.0}, {}, 1.0}).value);
}

/// Catches the motion's own command, or a few late breakaways, taken for noise; and runs compared from their first
/// rows.
TEST(CommandNoise, IsWhatDiffersBetweenEqualRuns) {
  constexpr double kNoise_V = 0.02;
  std::mt19937 random{3};
  std::normal_distribution<double> normal;
  const auto run = [&](std::size_t rest, bool sticks) {
    host::Record record;
    for (std::size_t k = 0; k < 4000 + rest; ++k) {
      const double moved = k < rest ? 0.0 : static_cast<double>(k - rest);
      record.t_s.push_back(0.001 * static_cast<double>(k));
      record.x_ref.push_back(moved);
      record.u_V.push_back(3.0 * std::sin(0.01 * moved) + kNoise_V * normal(random) +
                           (sticks && k % 20 == 0 ? 1.0 : 0.0));
    }
    return record;
  };
  EXPECT_NEAR(host::command_noise_V(run(20, false), run(50, true)), kNoise_V, 0.1 * kNoise_V);
}

}  // namespace
