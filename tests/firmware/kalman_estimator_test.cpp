// The estimator against eq. (43) as the paper prints it, in matrices and double precision.
#include "firmware/core/control/kalman_estimator.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "tests/firmware/paper_axes.hpp"

namespace {

using firmware_test::kEncoderResolution_mm;
using firmware_test::PaperAxis;

struct MatrixEstimator {
  explicit MatrixEstimator(const PaperAxis& axis) {
    Eigen::Matrix3d A;
    A << 1.0, axis.Ad12, -axis.Bd1, 0.0, axis.Ad22, -axis.Bd2, 0.0, 0.0, 1.0;
    const Eigen::Vector3d B(axis.Bd1, axis.Bd2, 0.0);
    Eigen::Matrix<double, 2, 3> C;
    C << 1.0, 0.0, 0.0, 0.0, 1.0, 0.0;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 2; ++column) K(row, column) = axis.Kobs[row][column];
    const Eigen::Matrix3d reduction = Eigen::Matrix3d::Identity() - K * C;
    F = reduction * A;
    G = reduction * B;
  }

  void update(double u, double x_m, double w_m) { state = (F * state + G * u + K * Eigen::Vector2d(x_m, w_m)).eval(); }

  Eigen::Matrix3d F;
  Eigen::Vector3d G;
  Eigen::Matrix<double, 3, 2> K;
  Eigen::Vector3d state = Eigen::Vector3d::Zero();
};

/// Largest difference over 5 s of random inputs and readings, relative to the size that each state reaches.
template <typename Scalar>
double worst_difference(const PaperAxis& axis, std::int64_t start_counts) {
  const auto p = firmware_test::parameters_of<Scalar>(axis);
  firmware::KalmanEstimator<Scalar> estimator;
  estimator.configure(p.drive, p.Kobs, p.encoder_resolution);
  auto estimate = estimator.at_rest(start_counts);
  MatrixEstimator reference(axis);

  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Eigen::Vector3d worst = Eigen::Vector3d::Zero(), size = Eigen::Vector3d::Zero();
  std::int64_t counts = 0;
  for (int k = 0; k < 5000; ++k) {
    const double phase = 2.0 * 3.14159265358979 * k / 1000.0;
    const auto u = static_cast<Scalar>(2.0 * unit(random));
    const auto w = static_cast<Scalar>(60.0 * std::cos(phase) + 0.2 * unit(random));
    counts = static_cast<std::int64_t>(std::floor(6000.0 * std::sin(phase)));
    estimator.update(estimate, u, start_counts + counts, w);
    reference.update(static_cast<double>(u), static_cast<double>(counts) * kEncoderResolution_mm,
                     static_cast<double>(w));
    const Eigen::Vector3d ours(static_cast<double>(estimate.anchor_counts - start_counts) * kEncoderResolution_mm +
                                   static_cast<double>(estimate.offset),
                               static_cast<double>(estimate.velocity), static_cast<double>(estimate.disturbance));
    worst = worst.cwiseMax((ours - reference.state).cwiseAbs());
    size = size.cwiseMax(reference.state.cwiseAbs());
  }
  EXPECT_EQ(estimate.anchor_counts, start_counts + counts);
  return worst.cwiseQuotient(size).maxCoeff();
}

class KalmanEstimator : public testing::TestWithParam<const PaperAxis*> {};
INSTANTIATE_TEST_SUITE_P(PaperAxes, KalmanEstimator, testing::Values(&firmware_test::kPaperX, &firmware_test::kPaperY));

TEST_P(KalmanEstimator, IsEquation43) { EXPECT_LT(worst_difference<double>(*GetParam(), 0), 1e-12); }

TEST_P(KalmanEstimator, InFloatLosesNoMoreThanAFewRoundings) {
  EXPECT_LT(worst_difference<float>(*GetParam(), 0), 1e-5);
}

TEST_P(KalmanEstimator, HasTheSameResolutionTenMetresFromZero) {
  const auto ten_metres = static_cast<std::int64_t>(10000.0 / kEncoderResolution_mm);
  EXPECT_DOUBLE_EQ(worst_difference<float>(*GetParam(), ten_metres), worst_difference<float>(*GetParam(), 0));
}

TEST(KalmanEstimatorWithoutTachometer, NeedsNoVelocityReading) {
  auto p = firmware_test::parameters_of<float>(firmware_test::kPaperX);
  firmware::KalmanEstimator<float> without_reading;
  without_reading.configure(p.drive, p.Kobs, p.encoder_resolution);
  firmware::KalmanEstimator<float> with_zero_column;
  for (auto& row : p.Kobs) row[1] = 0.0f;
  with_zero_column.configure(p.drive, p.Kobs, p.encoder_resolution);
  auto without = without_reading.at_rest(0), with_zero = without;
  for (std::int64_t k = 0; k < 1000; ++k) {
    without_reading.update(without, 0.3f, 2 * k);
    with_zero_column.update(with_zero, 0.3f, 2 * k, 1000.0f);
  }
  EXPECT_EQ(without.velocity, with_zero.velocity);
  EXPECT_EQ(without.disturbance, with_zero.disturbance);
  // 2 counts a millisecond: 2 * dx / (lead Ts)
  EXPECT_NEAR(static_cast<double>(without.velocity),
              2.0 * kEncoderResolution_mm / firmware_test::kLead_mm_per_rad / 1e-3, 0.01);
}

}  // namespace
