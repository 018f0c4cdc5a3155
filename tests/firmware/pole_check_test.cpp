// The pole check against eigenvalues in double precision; gains that must never close a loop.
#include "firmware/core/control/pole_check.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <random>

#include "firmware/core/fixed_units.hpp"
#include "tests/firmware/paper_axes.hpp"

namespace {

using firmware::AxisParameters;
using firmware::PoleProblem;
using Pole = std::complex<double>;

/// Directly by the definitions: eigenvalues of the matrices of eqs. (16), (43) and (50).
template <typename Matrix>
PoleProblem verdict(const Matrix& matrix, double sample_period_s, double tolerance, bool& is_near_a_limit) {
  const auto values = matrix.eigenvalues();
  const auto below = [&](double value, double limit) {
    is_near_a_limit = is_near_a_limit || std::abs(value - limit) < tolerance;
    return value < limit;
  };
  bool unstable = false, undamped = false, slow = false;
  for (const Pole z : values) {
    unstable = !below(std::abs(z), 1.0) || unstable;
    const Pole s = (z - 1.0) / (z + 1.0);
    if (std::abs(z.imag()) > 1e-9)
      undamped = below(-s.real() / std::abs(s), static_cast<double>(firmware::kLeastDamping)) || undamped;
    if (z.real() < 0.0 || std::abs(z.real()) < tolerance)
      undamped = !below(std::abs(z), static_cast<double>(firmware::kFastestRinging)) || undamped;
    if (std::abs(z.imag()) < 1e-3) is_near_a_limit = is_near_a_limit || std::abs(z.imag()) > 1e-12;  // pair or two
    slow = !below(std::abs(z), 1.0 - sample_period_s / static_cast<double>(firmware::kLongestMode_s)) || slow;
  }
  return unstable   ? PoleProblem::unstable
         : undamped ? PoleProblem::undamped
         : slow     ? PoleProblem::slow
                    : PoleProblem::none;
}

Eigen::Matrix3d estimator_matrix(const AxisParameters<float>& p) {
  const auto& d = p.drive;
  Eigen::Matrix3d A;
  A << 1.0, static_cast<double>(d.Ad12), -static_cast<double>(d.Bd1), 0.0, static_cast<double>(d.Ad22),
      -static_cast<double>(d.Bd2), 0.0, 0.0, 1.0;
  Eigen::Matrix<double, 3, 2> K;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 2; ++column)
      K(row, column) =
          column == 1 && !p.tachometer_fitted
              ? 0.0
              : static_cast<double>(p.Kobs[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)]);
  Eigen::Matrix<double, 2, 3> C;
  C << 1, 0, 0, 0, 1, 0;
  return (Eigen::Matrix3d::Identity() - K * C) * A;
}

Eigen::Matrix2d loop_matrix(const AxisParameters<float>& p) {
  const auto& d = p.drive;
  Eigen::Matrix2d A;
  A << 1.0, static_cast<double>(d.Ad12), 0.0, static_cast<double>(d.Ad22);
  return A - Eigen::Vector2d(static_cast<double>(d.Bd1), static_cast<double>(d.Bd2)) *
                 Eigen::RowVector2d(static_cast<double>(p.Kc[0]), static_cast<double>(p.Kc[1]));
}

AxisParameters<float> paper() { return firmware_test::parameters_of<float>(firmware_test::kPaperX); }

TEST(PoleCheck, AgreesWithEigenvaluesForGainsOfEveryKind) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> scale(-0.5f, 3.0f);
  int told[4] = {};
  for (int trial = 0; trial < 20'000; ++trial) {
    auto p = paper();
    p.tachometer_fitted = trial % 2 == 0;
    for (auto& row : p.Kobs)
      for (float& gain : row) gain *= scale(random);
    for (float& gain : p.Kc) gain *= 2.0f * scale(random);
    bool near_estimator = false, near_loop = false;
    const PoleProblem estimator = verdict(estimator_matrix(p), 1e-3, 1e-3, near_estimator);
    const PoleProblem loop = verdict(loop_matrix(p), 1e-3, 1e-3, near_loop);
    ++told[static_cast<int>(estimator)];
    if (!near_estimator) {
      ASSERT_EQ(firmware::estimator_problem(p), estimator) << trial << '\n' << estimator_matrix(p).eigenvalues();
    }
    if (!near_loop) {
      ASSERT_EQ(firmware::loop_problem(p), loop) << trial << '\n' << loop_matrix(p).eigenvalues();
    }
  }
  for (const int times : {told[0], told[1], told[2]}) EXPECT_GT(times, 100) << "the trials are one-sided";
}

TEST(PoleCheck, ThePapersSetsPassInFloatAndInFixedPoint) {
  for (const auto& axis : {firmware_test::kPaperX, firmware_test::kPaperY}) {
    const auto p = firmware_test::parameters_of<float>(axis);
    EXPECT_EQ(firmware::estimator_problem(p), PoleProblem::none);
    EXPECT_EQ(firmware::loop_problem(p), PoleProblem::none);
    const auto q = firmware::to_fixed(firmware_test::parameters_of<double>(axis));
    EXPECT_EQ(firmware::estimator_problem(q), PoleProblem::none);
    EXPECT_EQ(firmware::loop_problem(q), PoleProblem::none);
  }
}

TEST(PoleCheck, AnEstimatorThatLooksAtNothingIsRefused) {
  auto p = paper();
  p.Kobs = {};
  EXPECT_EQ(firmware::estimator_problem(p), PoleProblem::unstable);
  EXPECT_EQ(firmware::check_poles(p), firmware::Refusal::estimator_poles);
  p = paper();
  for (auto& row : p.Kobs)
    for (float& gain : row) gain *= 1e-5f;
  EXPECT_NE(firmware::estimator_problem(p), PoleProblem::none) << "nor an estimator with hardly any correction";
}

TEST(PoleCheck, AnEstimatorThatLivesOnAMissingTachometerIsRefused) {
  auto p = paper();
  for (auto& row : p.Kobs) row[0] = 0.0f;
  p.tachometer_fitted = false;
  EXPECT_EQ(firmware::estimator_problem(p), PoleProblem::unstable);
}

TEST(PoleCheck, ALoopThatRingsAtHalfTheSampleRateIsRefused) {
  auto p = paper();
  p.Kc[1] = 1.95f / p.drive.Bd2;  // its fast pole at -0.95
  EXPECT_EQ(firmware::loop_problem(p), PoleProblem::undamped);
  EXPECT_EQ(firmware::check_poles(p), firmware::Refusal::loop_poles);
  p.Kc[1] = 2.1f / p.drive.Bd2;
  EXPECT_EQ(firmware::loop_problem(p), PoleProblem::unstable);
}

TEST(PoleCheck, NoFeedbackAndFeedbackOfTheWrongSignAreRefused) {
  auto p = paper();
  p.Kc = {};
  EXPECT_EQ(firmware::loop_problem(p), PoleProblem::unstable);
  p = paper();
  p.Kc[0] = -p.Kc[0];
  EXPECT_EQ(firmware::loop_problem(p), PoleProblem::unstable);
}

}  // namespace
