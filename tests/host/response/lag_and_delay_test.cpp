// Lag or delay: drives whose sampled response is a matrix exponential, independent of the fit's formula.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>

#include "host/dense_solutions.hpp"
#include "host/response/plant_fit.hpp"

namespace {

constexpr double kPeriod_s = 1e-3;

/// Position of a mass after a hold, optionally with a current loop and a delay in samples.
std::complex<double> answer(double f_Hz, double lag_s, int samples_late) {
  constexpr double kGain = 4000.0, kViscous = 5.0;
  Eigen::Matrix4d held = Eigen::Matrix4d::Zero();  // position, speed, current, command
  held(0, 1) = 1.0;
  held(1, 1) = -kViscous;
  held(1, lag_s > 0.0 ? 2 : 3) = kGain;
  if (lag_s > 0.0) {
    held(2, 2) = -1.0 / lag_s;
    held(2, 3) = 1.0 / lag_s;
  }
  const Eigen::Matrix4d sampled = host::exponential(held * kPeriod_s);
  const std::complex<double> z = std::polar(1.0, 2.0 * std::numbers::pi * f_Hz * kPeriod_s);
  const Eigen::Matrix3cd rest = z * Eigen::Matrix3cd::Identity() - sampled.topLeftCorner<3, 3>();
  const Eigen::Vector3cd state = rest.partialPivLu().solve(sampled.topRightCorner<3, 1>().cast<std::complex<double>>());
  return state(0) * std::pow(z, -samples_late);
}

host::PlantFit fitted(double lag_s, int samples_late) {
  host::FrequencyResponse response;
  response.sample_period_s = kPeriod_s;
  response.has_position = true;
  for (double f = 4.0; f < 250.0; f *= 1.13) {
    host::ResponseLine line;
    line.f_Hz = f;
    line.plant(0) = answer(f, lag_s, samples_late);
    line.covariance(0, 0) = 2.0 * std::norm(0.01 * line.plant(0));
    line.degrees = 9.0;
    response.lines.push_back(line);
  }
  return host::fit_plant(response);
}

/// A fit with only a delay adjusts the magnitudes by a nonexistent resonance.
TEST(PhaseThatTurns, IsACurrentLoopWhereTheMagnitudeFallsToo) {
  const host::PlantFit fit = fitted(1.59e-3, 0);
  EXPECT_TRUE(fit.resonances.empty());
  EXPECT_EQ(fit.delay_s.value, 0.0);
  EXPECT_NEAR(fit.lag_s.value, 1.59e-3, 0.02 * 1.59e-3);
  EXPECT_LT(fit.lag_s.ci95[0], 1.59e-3);
  EXPECT_GT(fit.lag_s.ci95[1], 1.59e-3);
}

TEST(PhaseThatTurns, IsADelayWhereItDoesNot) {
  const host::PlantFit fit = fitted(0.0, 2);
  EXPECT_TRUE(fit.resonances.empty());
  EXPECT_EQ(fit.lag_s.value, 0.0);
  EXPECT_NEAR(fit.delay_s.value, 2e-3, 4e-5);
}

TEST(PhaseThatTurns, IsNeitherOnADriveWithoutThem) {
  const host::PlantFit fit = fitted(0.0, 0);
  EXPECT_EQ(fit.lag_s.value, 0.0);
  EXPECT_NEAR(fit.delay_s.value, 0.0, 4e-5);
}

}  // namespace
