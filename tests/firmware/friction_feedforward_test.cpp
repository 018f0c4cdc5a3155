// Friction feed-forward against eq. (19) with the C library's exponential.
#include "firmware/core/friction_feedforward.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/firmware/paper_axes.hpp"

namespace {

using firmware::exp_negative;
using firmware_test::kPaperX;
using firmware_test::kPaperY;
using firmware_test::PaperAxis;

TEST(ExpNegative, StaysWithinItsStatedError) {
  for (int i = 0; i < 870000; ++i) {
    const float y = static_cast<float>(i) * 1e-4f;
    const double exact = std::exp(-static_cast<double>(y));
    const double relative = std::abs(static_cast<double>(exp_negative(y)) - exact) / exact;
    ASSERT_LT(relative, 7.5e-8 * (3.0 + static_cast<double>(y))) << y;
  }
}

TEST(ExpNegative, EndsOfTheRange) {
  EXPECT_EQ(exp_negative(0.0f), 1.0f);
  EXPECT_EQ(exp_negative(-3.0f), 1.0f);
  EXPECT_EQ(exp_negative(87.0f), 0.0f);
  EXPECT_EQ(exp_negative(std::numeric_limits<float>::infinity()), 0.0f);
  EXPECT_GT(exp_negative(86.9f), 0.0f);
}

/// Eq. (19) in volts; `side` 0 is the positive direction. Magnitude.
double equation_19_V(const PaperAxis& axis, int side, double speed) {
  const double torque = axis.static_Nm[side] * std::exp(-speed / axis.omega1_rad_s[side]) +
                        axis.coulomb_Nm[side] * (1.0 - std::exp(-speed / axis.omega2_rad_s[side])) +
                        (axis.viscous_Nm_s_per_rad - axis.model_viscous_Nm_s_per_rad) * speed;
  return torque / (axis.amplifier_gain_A_per_V * firmware_test::kMotorConstant_Nm_per_A);
}

class FrictionFeedforward : public testing::TestWithParam<const PaperAxis*> {
 protected:
  void SetUp() override { friction.configure(firmware_test::parameters_of<float>(*GetParam()).friction); }
  const double blend = 0.2;  // rad/s, as parameters_of() sets it
  firmware::FrictionFeedforward<float> friction;
};
INSTANTIATE_TEST_SUITE_P(PaperAxes, FrictionFeedforward, testing::Values(&kPaperX, &kPaperY));

TEST_P(FrictionFeedforward, IsEquation19InBothDirections) {
  constexpr double kTolerance_V = 20.0 / 65536.0 / 30.0;  // a thirtieth of a step of the converter
  for (int i = 0; i <= 2000; ++i) {
    const double w = blend * std::pow(800.0, i / 2000.0);  // up to 160 rad/s
    ASSERT_NEAR(static_cast<double>(friction(static_cast<float>(w))), equation_19_V(*GetParam(), 0, w), kTolerance_V);
    ASSERT_NEAR(static_cast<double>(friction(static_cast<float>(-w))), -equation_19_V(*GetParam(), 1, w), kTolerance_V);
  }
}

TEST_P(FrictionFeedforward, IsContinuousThroughZeroAndZeroAtRest) {
  EXPECT_EQ(friction(0.0f), 0.0f);
  EXPECT_EQ(friction(-0.0f), 0.0f);
  const double steepest = std::max(equation_19_V(*GetParam(), 0, blend), equation_19_V(*GetParam(), 1, blend)) / blend;
  const double step = 1e-3;
  double last = static_cast<double>(friction(-1.0f));
  for (int i = -999; i <= 1000; ++i) {
    const double w = i * step;
    const double now = static_cast<double>(friction(static_cast<float>(w)));
    ASSERT_LE(std::abs(now - last), 1.01 * steepest * step) << w;
    last = now;
  }
}

TEST(FrictionFeedforwardWithoutStribeck, OmegaZeroMeansThatTheExponentialIsZero) {
  firmware::FrictionFeedforward<float> friction;
  const firmware::FrictionDirection<float> coulomb_only{5.0f, 2.0f, 0.5f, 0.0f, 0.0f};
  friction.configure({coulomb_only, coulomb_only, 0.1f});
  EXPECT_FLOAT_EQ(friction(1.0f), 2.5f);
  EXPECT_FLOAT_EQ(friction(-4.0f), -4.0f);
  EXPECT_FLOAT_EQ(friction(0.05f), 0.5f * (2.0f + 0.05f));
}

}  // namespace
