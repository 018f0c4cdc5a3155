// How long requests block the control interrupt of the emulated processor while both axes move.
#include <gtest/gtest.h>

#include "tests/target/cost/cost.hpp"
#include "tests/target/qemu.hpp"

namespace {

/// Instructions of a control period at the highest rate, 20 kHz of 168 MHz.
constexpr int kShortestPeriod = 8400;

/// Float and fixed point.
class ShutOut : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Scalars, ShutOut, testing::Values("shut-out-m4", "shut-out-fixed-m4"));

TEST_P(ShutOut, IsATenthOfAPeriodAtMostWhileAxesMove) {
  const std::string why = target_test::obstacle(GetParam());
  if (!why.empty()) GTEST_SKIP() << why;
  auto costs = target_test::count_instructions(GetParam());
  EXPECT_GT(costs["parameter_change"].worst, 0);
  EXPECT_LE(costs["parameter_change"].worst, 100) << "limits of the board, and nothing of an axis";
  EXPECT_GT(costs["other_requests"].worst, 0);
  EXPECT_LE(costs["other_requests"].worst, kShortestPeriod / 10);
}

/// A set that changes every value: 2 ms in all at one instruction per clock, and 20 us with the control interrupt
/// disabled.
TEST_P(ShutOut, IsShortWhileASetIsTakenOver) {
  const std::string why = target_test::obstacle(GetParam());
  if (!why.empty()) GTEST_SKIP() << why;
  auto costs = target_test::count_instructions(GetParam());
  EXPECT_LE(costs["commit_at_standstill"].worst, 336'000);
  EXPECT_GT(costs["commit_at_standstill"].mean, 10'000) << "nothing was taken over";
  EXPECT_LE(costs["commit_at_standstill_shut_out"].worst, 3'360);
  EXPECT_GT(costs["commit_at_standstill_shut_out"].worst, 0);
}

/// The watches of process force and friction feed-forward for both axes, once a control period in the background.
TEST_P(ShutOut, TheBackgroundsWatchesTakeLittle) {
  const std::string why = target_test::obstacle(GetParam());
  if (!why.empty()) GTEST_SKIP() << why;
  auto costs = target_test::count_instructions(GetParam());
  EXPECT_GT(costs["watches"].mean, 100) << "nothing was watched";
  EXPECT_LE(costs["watches"].worst, kShortestPeriod / 10);
}

/// Catches a velocity whose unit is taken from parameters computed for that alone: 1324 instructions in fixed point.
TEST_P(ShutOut, TheStateOfAnAxisIsToldWithoutComputingItsParameters) {
  const std::string why = target_test::obstacle(GetParam());
  if (!why.empty()) GTEST_SKIP() << why;
  auto costs = target_test::count_instructions(GetParam());
  EXPECT_GT(costs["axis_status"].mean, 50) << "nothing was told";
  EXPECT_LE(costs["axis_status"].worst, 150);
}

}  // namespace
