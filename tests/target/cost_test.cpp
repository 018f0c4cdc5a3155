// Holds the control law to its budget of executed instructions.
#include "tests/target/cost/cost.hpp"

#include <gtest/gtest.h>

#include "tests/target/qemu.hpp"

namespace {

using target_test::count_instructions;

class CostOfAStep : public testing::Test {
 protected:
  void SetUp() override {
    const std::string why = target_test::obstacle("cost-float-m4");
    if (!why.empty()) GTEST_SKIP() << why;
  }
};

TEST_F(CostOfAStep, CountsAreExactAndRepeatable) {
  auto first = count_instructions("cost-float-m4");
  EXPECT_EQ(first["100_nops"].worst, 100);
  EXPECT_EQ(first, count_instructions("cost-float-m4"));
}

TEST_F(CostOfAStep, FloatKeepsItsBudget) {
  auto costs = count_instructions("cost-float-m4");
  EXPECT_LE(costs["estimator_and_feedback"].worst, 90);
  EXPECT_LE(costs["control_filters"].worst, 80) << "notch and low-pass";
  EXPECT_GT(costs["control_filters"].mean, 30) << "nothing was filtered";
  // With all monitors, homed, everything switched on. The budget applies to the average; the worst step is during a
  // ramp.
  EXPECT_LE(costs["one_axis"].mean, 448);
  EXPECT_LE(costs["both_axes"].mean, 987);
  EXPECT_LE(costs["one_axis"].worst, 560);
  EXPECT_LE(costs["both_axes"].worst, 1240);
  EXPECT_LT(costs["both_axes"].worst * 20e3 / 168e6, 0.15) << "share of the chip at 20 kHz";
  EXPECT_GT(costs["one_axis"].mean, 100) << "the step did nothing";
}

TEST_F(CostOfAStep, ExperimentsKeepTheirBudget) {
  auto costs = count_instructions("cost-float-m4");
  EXPECT_LE(costs["both_axes_excited"].worst, 1420) << "as many lines as there may be";
  EXPECT_GT(costs["both_axes_excited"].mean, costs["both_axes"].mean + 200) << "nothing was excited";
  EXPECT_LE(costs["captured_row"].worst, 200) << "four channels";
}

TEST_F(CostOfAStep, PathsKeepTheirBudget) {
  auto costs = count_instructions("cost-float-m4");
  // The budget applies to the average; in the worst step the path's clock changes and a piece ends.
  EXPECT_LE(costs["both_axes_on_path"].mean, 1262);
  EXPECT_LE(costs["both_axes_on_path"].worst, 1545);
  EXPECT_GT(costs["both_axes_on_path"].mean, costs["both_axes"].mean + 50) << "nothing was followed";
  EXPECT_LE(costs["excited_and_on_path"].mean, 1496) << "one axis excited by all lines, the other on the path";
  EXPECT_LE(costs["excited_and_on_path"].worst, 1780);
  EXPECT_GT(costs["excited_and_on_path"].mean, costs["both_axes_excited"].mean + 50) << "nothing was followed";
}

TEST_F(CostOfAStep, FixedPointTakesAtMostTwoAndAHalfTimesFloat) {
  auto in_float = count_instructions("cost-float-m4");
  for (const char* image : {"cost-fixed-m4", "cost-fixed-m3"}) {
    auto in_fixed = count_instructions(image);
    EXPECT_LE(in_fixed["one_axis"].worst, 2.5 * in_float["one_axis"].worst) << image;
    EXPECT_LE(in_fixed["both_axes"].worst, 2.5 * in_float["both_axes"].worst) << image;
  }
}

TEST_F(CostOfAStep, FixedPointBeatsSoftwareFloatWithoutFpu) {
  EXPECT_LT(count_instructions("cost-fixed-m0plus")["one_axis"].worst,
            count_instructions("cost-float-m0plus")["one_axis"].worst);
  EXPECT_LT(count_instructions("cost-fixed-m3")["one_axis"].worst,
            count_instructions("cost-float-m3")["one_axis"].worst);
}

}  // namespace
