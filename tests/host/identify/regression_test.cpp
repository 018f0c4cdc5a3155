// Filters, least squares and tachometer calibration of the estimates. Expected values are in closed form.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

#include "host/identify/least_squares.hpp"
#include "host/identify/tachometer.hpp"
#include "host/identify/zero_phase_filter.hpp"

namespace {

constexpr double kPi = std::numbers::pi;

std::vector<double> cosine(double frequency_Hz, double rate_Hz, std::size_t samples, double phase = 0.0) {
  std::vector<double> signal(samples);
  for (std::size_t k = 0; k < samples; ++k) {
    signal[k] = std::cos(2.0 * kPi * frequency_Hz * static_cast<double>(k) / rate_Hz + phase);
  }
  return signal;
}

/// Complex amplitude at a frequency in the middle half of a signal.
std::complex<double> amplitude_of(const std::vector<double>& signal, double frequency_Hz, double rate_Hz) {
  std::complex<double> sum = 0.0;
  const std::size_t begin = signal.size() / 4, end = begin + signal.size() / 2;
  for (std::size_t k = begin; k < end; ++k) {
    sum += signal[k] * std::polar(1.0, -2.0 * kPi * frequency_Hz * static_cast<double>(k) / rate_Hz);
  }
  return 2.0 * sum / static_cast<double>(end - begin);
}

TEST(ZeroPhaseFilter, ButterworthHalvesTheAmplitudeAtItsCutOffAndShiftsNothing) {
  const auto filter = host::ZeroPhaseLowPass::butterworth(100.0, 1000.0);
  for (const double f : {10.0, 50.0, 100.0, 200.0}) {
    // 4th order with pre-warping, both directions: |H|^2 = 1 / (1 + (tan(pi f/fs) / tan(pi fc/fs))^8).
    const double expected = 1.0 / (1.0 + std::pow(std::tan(kPi * f / 1000.0) / std::tan(kPi * 0.1), 8));
    const auto gain = amplitude_of(filter(cosine(f, 1000.0, 4000)), f, 1000.0);
    EXPECT_NEAR(gain.real(), expected, 1e-6) << f;
    EXPECT_NEAR(gain.imag(), 0.0, 1e-6) << f;
  }
}

TEST(ZeroPhaseFilter, ChebyshevStaysWithinItsRippleAndIsSteep) {
  const auto filter = host::ZeroPhaseLowPass::chebyshev(40.0, 1000.0);
  const double ripple = std::pow(10.0, 0.1 / 20.0);  // twice 0.05 dB, upwards from gain 1 at 0 Hz
  for (const double f : {1.0, 10.0, 25.0, 39.0}) {
    const auto gain = amplitude_of(filter(cosine(f, 1000.0, 8000)), f, 1000.0);
    EXPECT_GE(std::abs(gain), 1.0 - 1e-3) << f;
    EXPECT_LE(std::abs(gain), ripple + 1e-3) << f;
    EXPECT_NEAR(gain.imag(), 0.0, 1e-6) << f;
  }
  EXPECT_LT(std::abs(amplitude_of(filter(cosine(60.0, 1000.0, 8000)), 60.0, 1000.0)), 1e-3);
}

TEST(ZeroPhaseFilter, LeavesRampsUnchangedUpToTheEnds) {
  std::vector<double> ramp(500);
  for (std::size_t k = 0; k < ramp.size(); ++k) ramp[k] = 3.0 - 0.2 * static_cast<double>(k);
  const std::vector<double> filtered = host::ZeroPhaseLowPass::butterworth(20.0, 1000.0)(ramp);
  for (std::size_t k = 0; k < ramp.size(); ++k) EXPECT_NEAR(filtered[k], ramp[k], 1e-5) << k;
}

TEST(ZeroPhaseFilter, DecimationKeepsEveryNthSampleOfASlowSignal) {
  const std::vector<double> slow = cosine(2.0, 1000.0, 3000);
  const std::vector<double> low = host::decimate(slow, 10, 1000.0);
  ASSERT_EQ(low.size(), 300u);
  // At 2 Hz the Chebyshev ripple is near its minimum: within 0.1 dB.
  for (std::size_t k = 30; k < 270; ++k) EXPECT_NEAR(low[k], slow[10 * k], 0.012) << k;
}

TEST(LeastSquares, SolvesAnExactSystemAndReportsItsCondition) {
  host::BlockedRegression<2> regression(10);
  for (int k = 0; k < 100; ++k) {
    const double a = k % 2 == 0 ? 1.0 : -1.0, b = k % 4 < 2 ? 100.0 : -100.0;
    regression.add({a, b}, 3.0 * a - 0.5 * b);
  }
  const host::Regression found = regression.solve();
  EXPECT_NEAR(found.parameters(0), 3.0, 1e-12);
  EXPECT_NEAR(found.parameters(1), -0.5, 1e-12);
  EXPECT_NEAR(found.condition_number, 1.0, 1e-12);  // orthogonal columns in any units
  EXPECT_EQ(found.rows, 100u);
}

TEST(LeastSquares, ManyRowsAtATimeAreTheSameRows) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::vector<std::array<double, 3>> rows(1000);
  for (auto& row : rows) row = {normal(random), 2.0 + normal(random), normal(random)};
  host::BlockedRegression<2> together(300), singly(300);  // blocks end between rows that are added at once
  together.add_rows(0, rows.size(), [&](std::size_t k, auto&& row) {
    for (int c = 0; c < 3; ++c) row(c) = rows[k][static_cast<std::size_t>(c)];
  });
  for (const auto& row : rows) singly.add({row[0], row[1]}, row[2]);
  const host::Regression found = together.solve(), expected = singly.solve();
  EXPECT_EQ(found.rows, expected.rows);
  EXPECT_TRUE(found.parameters.isApprox(expected.parameters, 1e-12));
  EXPECT_TRUE(found.covariance.isApprox(expected.covariance, 1e-10));
}

TEST(LeastSquares, SingularEquationsHaveNoEstimate) {
  host::BlockedRegression<2> regression(10);
  for (int k = 0; k < 100; ++k) regression.add({1.0 + k, 2.0 + 2.0 * k}, 1.0);
  const host::Regression found = regression.solve();
  EXPECT_TRUE(std::isinf(found.condition_number));
  EXPECT_TRUE(std::isnan(found.parameters(0)));
}

/// In a record at rest, a regression on sliding samples has no rows.
TEST(LeastSquares, NoRowsHaveNoEstimateEither) {
  const host::Regression found = host::BlockedRegression<4>(10).solve();
  EXPECT_TRUE(std::isinf(found.condition_number));
  ASSERT_EQ(found.parameters.size(), 4);
  EXPECT_TRUE(std::isnan(found.parameters(3)));
  EXPECT_EQ(found.covariance.rows(), 4);
}

TEST(LeastSquares, IntervalsCoverTheTruthWithColouredResiduals) {
  // Mean of an AR(1) process with coefficient 0.95. White-noise intervals would contain it in only 25 % of the cases.
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal;
  int covered = 0;
  constexpr int kTrials = 400;
  for (int trial = 0; trial < kTrials; ++trial) {
    host::BlockedRegression<1> regression(200);
    double state = 0.0;
    for (int k = 0; k < 10000; ++k) {
      state = 0.95 * state + normal(generator);
      regression.add(host::BlockedRegression<1>::Row(1.0), state);
    }
    const host::Regression found = regression.solve();
    covered += std::abs(found.parameters(0)) <= found.t_quantile * std::sqrt(found.covariance(0, 0)) ? 1 : 0;
  }
  // 95 % of 400 with a binomial standard deviation of 4.4. Blocks of ten correlation lengths lose about 2 %.
  EXPECT_GE(covered, 360);
  EXPECT_LE(covered, 396);
}

TEST(LeastSquares, StudentsTMatchesItsTable) {
  EXPECT_NEAR(host::student_t_95(1), 12.706, 1e-3);
  EXPECT_NEAR(host::student_t_95(2), 4.303, 1e-3);
  EXPECT_NEAR(host::student_t_95(5), 2.571, 5e-3);
  EXPECT_NEAR(host::student_t_95(10), 2.228, 1e-3);
  EXPECT_NEAR(host::student_t_95(50), 2.009, 1e-3);
}

class TachometerRecord : public testing::Test {
 protected:
  static constexpr double kStep_mm = 10.0 / 4096.0, kLead = 10.0 / (2.0 * kPi);

  void SetUp() override {
    data.lead = kLead;
    data.encoder_resolution = kStep_mm;
    data.tach_noise_variance = 0.05;
    record.sample_period_s = 0.001;
    std::mt19937_64 generator(3);
    std::normal_distribution<double> noise(0.0, std::sqrt(0.05));
    for (int k = 0; k < 10000; ++k) {
      // Two seconds of standstill, then a slow oscillation of +-40 rad/s.
      const double t = 0.001 * k, moving = std::max(0.0, t - 2.0), circle = 2.0 * kPi * 0.5;
      const double angle = 40.0 / circle * (1.0 - std::cos(circle * moving)), w = 40.0 * std::sin(circle * moving);
      record.t_s.push_back(t);
      record.u_V.push_back(0.0);
      record.x.push_back(kStep_mm * std::floor(angle * kLead / kStep_mm));
      record.w.push_back(1.01 * w + 0.07 + noise(generator));
    }
  }
  host::Record record;
  sim::DataSheet data;
};

TEST_F(TachometerRecord, GainAndOffsetAreFoundAgainstTheEncoder) {
  const auto found = host::calibrate_tachometer({record}, data);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->gain.value, 1.01, 2e-4);
  EXPECT_NEAR(found->offset.value, 0.07, 0.006);  // 0.22/sqrt(10000) is the deviation of the mean: 0.0022
  EXPECT_LT(found->gain.ci95[0], 1.01);
  EXPECT_GT(found->gain.ci95[1], 1.01);
}

TEST_F(TachometerRecord, VarianceComesFromTheStandstillAlone) {
  const auto variance = host::standstill_variance({record}, data);
  ASSERT_TRUE(variance);
  EXPECT_NEAR(*variance, 0.05, 0.0065);  // 2000 samples: deviation 0.05*sqrt(2/2000) = 0.0016, four of them
}

TEST_F(TachometerRecord, NothingIsClaimedWithoutMotionOrWithoutEncoder) {
  host::Record still = record;
  std::ranges::fill(still.x, 0.0);
  EXPECT_FALSE(host::calibrate_tachometer({still}, data));
  host::Record blind = record;
  blind.x.clear();
  EXPECT_FALSE(host::calibrate_tachometer({blind}, data));
  EXPECT_FALSE(host::standstill_variance({blind}, data));
}

}  // namespace
