#include "host/evidence/period_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// Travel from 0 to `travel` and back, 0.04 mm per sample, each sample with weight 2.
host::TravelSignal there_and_back(double travel) {
  host::TravelSignal signal;
  constexpr double kStep = 0.04;
  const int count = static_cast<int>(travel / kStep);
  for (int k = 0; k < 2 * count; ++k) signal.x.push_back(kStep * (k < count ? k : 2 * count - k));
  signal.value.assign(signal.x.size(), 0.0);
  signal.weight.assign(signal.x.size(), 2.0);
  return signal;
}

void add(host::TravelSignal& signal, double period, double cosine, double sine) {
  for (std::size_t k = 0; k < signal.x.size(); ++k) {
    const double angle = kTwoPi * signal.x[k] / period;
    signal.value[k] += signal.weight[k] * (cosine * std::cos(angle) + sine * std::sin(angle));
  }
}

TEST(PeriodSearch, FindsTwoPeriodsThatAreNoMultiplesOfEachOther) {
  host::TravelSignal signal = there_and_back(120.0);
  const double second = 10.0 / std::sqrt(7.0);  // 3.78 mm; an irrational ratio to the first period
  add(signal, 10.0, 0.30, -0.40);
  add(signal, second, 0.10, 0.20);
  const auto peaks = host::find_periods(signal, 0.5, 60.0, 2);
  ASSERT_EQ(peaks.size(), 2u);
  // The grid of orders is refined to 1/32 of the resolution 1/travel, so one step is period^2/(32 travel).
  EXPECT_NEAR(peaks[0].period, 10.0, 10.0 * 10.0 / (32.0 * 120.0));
  EXPECT_NEAR(peaks[1].period, second, second * second / (32.0 * 120.0));
  // Squared amplitudes of the two: 0.25 and 0.05 of 0.30.
  EXPECT_NEAR(peaks[0].share, 0.25 / 0.30, 0.01);
  EXPECT_NEAR(peaks[1].share, 0.05 / 0.30, 0.01);
  EXPECT_NEAR(std::hypot(peaks[0].cosine, peaks[0].sine), 0.5, 0.02);
  EXPECT_NEAR(std::hypot(peaks[1].cosine, peaks[1].sine), std::sqrt(0.05), 0.02);
}

TEST(PeriodSearch, LeavesOutPeriodsBeyondTheBounds) {
  host::TravelSignal signal = there_and_back(120.0);
  add(signal, 10.0, 1.0, 0.0);
  for (const host::PeriodPeak& peak : host::find_periods(signal, 0.5, 6.0, 4)) {
    EXPECT_LT(peak.period, 6.5);
    EXPECT_LT(peak.share, 0.05);
  }
}

TEST(PeriodSearch, FindsNothingInATravelShorterThanTwoPeriods) {
  host::TravelSignal signal = there_and_back(4.0);
  add(signal, 3.0, 1.0, 0.0);
  EXPECT_TRUE(host::find_periods(signal, 2.5, 60.0, 4).empty());
}

}  // namespace
