// The knee by hand, and the noise of a command that is made of known parts.
#include "host/commission/estimator_choice.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

host::TrackingTest tested(double variance, double error_um, double noise_V, double repeats_um = 0.0) {
  host::TrackingTest test;
  test.disturbance_variance = variance;
  test.error_um = error_um;
  test.noise_V = noise_V;
  test.repeats_um = repeats_um;
  return test;
}

/// Error 1 to 0.16 for noise 1 to 2.5, and then 1 to 0.69 for noise 1 to 8.
TEST(EstimatorChoice, IsTheKnee) {
  const double fifth_um = 2.0 * std::pow(10.0, 0.2), fifth_V = 0.01 * std::pow(100.0, 0.2);
  const auto choice = host::choose_estimator(
      {tested(1e-4, 20.0, 0.01), tested(1e-3, fifth_um, fifth_V), tested(1e-2, 2.2, 0.2), tested(1e-1, 2.0, 1.0)});
  ASSERT_TRUE(choice.knee);
  EXPECT_EQ(*choice.knee, 1u);
  EXPECT_NE(choice.why.find("0.0001 V² follows 531 % worse with 60 % less noise"), std::string::npos) << choice.why;
  EXPECT_NE(choice.why.find("0.01 V² follows 31 % better with 696 % more noise"), std::string::npos) << choice.why;
}

/// Catches a knee that moves with the liveliest value, which is far from it.
TEST(EstimatorChoice, DoesNotDependOnTheLiveliest) {
  for (const double liveliest_um : {0.02, 1.9, 40.0})
    for (const double liveliest_V : {0.21, 5.0}) {
      const auto choice = host::choose_estimator({tested(1e-4, 20.0, 0.01), tested(1e-3, 3.2, 0.025),
                                                  tested(1e-2, 2.2, 0.2), tested(1e-1, liveliest_um, liveliest_V)});
      ASSERT_TRUE(choice.knee);
      EXPECT_EQ(*choice.knee, 1u) << liveliest_um << " um, " << liveliest_V << " V";
    }
}

/// Catches a larger value that is taken although it follows no better than equal runs differ, or worse.
TEST(EstimatorChoice, IsCalmWhereNoiseBuysNothing) {
  const auto choice =
      host::choose_estimator({tested(1e-4, 5.0, 0.01, 0.3), tested(1e-3, 4.8, 0.03, 0.3), tested(1e-2, 7.0, 0.1, 0.1)});
  ASSERT_TRUE(choice.knee);
  EXPECT_EQ(*choice.knee, 0u);
}

/// Catches a value that was never run, whose figures are zero.
TEST(EstimatorChoice, IsOfWhatWasRun) {
  host::TrackingTest stopped = tested(1e-1, 0.0, 0.0);
  stopped.unusable_because = "the loop oscillates";
  const auto choice = host::choose_estimator({tested(1e-3, 5.0, 0.02), stopped});
  ASSERT_TRUE(choice.knee);
  EXPECT_EQ(*choice.knee, 0u);
  EXPECT_FALSE(host::choose_estimator({stopped}).knee);
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
