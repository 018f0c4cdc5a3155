// Friction feed-forward against eq. (19) with the C library's exponential.
#include "firmware/core/control/friction_feedforward.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "firmware/core/arithmetic/fixed_point.hpp"
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

/// Error of a cubic through values and slopes at both ends of a piece of width h: h^4/384 of the largest fourth
/// derivative, plus twelve roundings, each half a unit in the last place of the curve's largest value.
double stated_error_V(const PaperAxis& axis, int side, double speed) {
  const double volts_per_Nm = 1.0 / (axis.amplifier_gain_A_per_V * firmware_test::kMotorConstant_Nm_per_A);
  const double omega1 = axis.omega1_rad_s[side], omega2 = axis.omega2_rad_s[side];
  const double smaller = std::min(omega1, omega2), larger = std::max(omega1, omega2);
  const double width = speed < 8.0 * smaller ? smaller / 4.0 : (16.0 * larger - 8.0 * smaller) / 32.0;
  const double begin = std::max(speed - width, 0.0);
  const double fourth = axis.static_Nm[side] / std::pow(omega1, 4.0) * std::exp(-begin / omega1) +
                        axis.coulomb_Nm[side] / std::pow(omega2, 4.0) * std::exp(-begin / omega2);
  const double rest = speed < 16.0 * larger ? std::pow(width, 4.0) / 384.0 * fourth
                                            : (axis.static_Nm[side] + axis.coulomb_Nm[side]) * std::exp(-16.0);
  const double largest_Nm = std::max(axis.static_Nm[side], axis.coulomb_Nm[side]);
  return (rest + 12.0 * std::ldexp(largest_Nm, -24)) * volts_per_Nm;
}

TEST_P(FrictionFeedforward, IsEquation19InBothDirections) {
  for (int i = 0; i <= 2000; ++i) {
    const double w = blend * std::pow(800.0, i / 2000.0);  // up to 160 rad/s
    ASSERT_NEAR(static_cast<double>(friction(static_cast<float>(w))), equation_19_V(*GetParam(), 0, w),
                stated_error_V(*GetParam(), 0, w));
    ASSERT_NEAR(static_cast<double>(friction(static_cast<float>(-w))), -equation_19_V(*GetParam(), 1, w),
                stated_error_V(*GetParam(), 1, w));
  }
}

/// `error`: as a share of the level.
template <typename Scalar>
void expect_stated_error(double error) {
  using Traits = firmware::ScalarTraits<Scalar>;
  for (const double ratio : {0.1, 0.3, 0.9, 3.0, 10.0}) {
    const double omega1 = 2.0, omega2 = omega1 * ratio, level = 1.0;
    const auto scalar = [](double value) { return Scalar(static_cast<float>(value)); };
    firmware::FrictionPieces<Scalar> pieces;
    pieces.configure({scalar(level), scalar(level), Scalar(0), scalar(omega1), scalar(omega2)});
    const double step = 0.05 * std::min(omega1, omega2), fastest = 20.0 * std::max(omega1, omega2);
    for (int i = 0; i * step < fastest; ++i) {
      const double speed = i * step;
      const double exact = level * std::exp(-speed / omega1) + level * (1.0 - std::exp(-speed / omega2));
      ASSERT_NEAR(static_cast<double>(Traits::to_float(pieces(scalar(speed)))), exact, error * level)
          << "at " << speed << ", omegas " << omega1 << " and " << omega2;
    }
  }
}

TEST(FrictionPieces, StayWithinTheirStatedErrorWhereTheOmegasDiffer) {
  expect_stated_error<float>(1.7e-4);
  expect_stated_error<firmware::FixedPoint>(1.7e-4);
}

/// A speed just below the end of a piece may be rounded into the next piece.
TEST(FrictionPieces, AreWholeAtTheirLastBorder) {
  for (int i = 1; i < 2000; ++i) {
    const float omega = 0.01f * static_cast<float>(i);
    firmware::FrictionPieces<float> pieces;
    pieces.configure({1.0f, 1.0f, 0.0f, omega, omega});
    ASSERT_NEAR(pieces(std::nextafter(16.0f * omega, 0.0f)), 1.0f, 1e-6f) << omega;
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
