#include "host/report/decimation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace host {
namespace {

constexpr double gap = std::numeric_limits<double>::quiet_NaN();

std::vector<std::size_t> decimated(const std::vector<double>& a, const std::vector<double>& b, std::size_t max_rows) {
  const std::span<const double> series[] = {a, b};
  return decimated_rows(series, max_rows);
}

bool contains(const std::vector<std::size_t>& rows, std::size_t row) {
  return std::binary_search(rows.begin(), rows.end(), row);
}

TEST(Decimation, KeepsEverythingThatFits) {
  const std::vector<double> values = {3.0, 1.0, 2.0};
  const std::span<const double> series[] = {values};
  EXPECT_EQ(decimated_rows(series, 5), (std::vector<std::size_t>{0, 1, 2}));
}

TEST(Decimation, KeepsSingleSampleSpikesOfEverySeriesAndBothEnds) {
  std::vector<double> smooth(100'000);
  for (std::size_t k = 0; k < smooth.size(); ++k) smooth[k] = std::sin(1e-3 * static_cast<double>(k));
  std::vector<double> spiky = smooth;
  smooth[12'345] = 40.0;
  spiky[54'321] = -40.0;
  const std::vector<std::size_t> rows = decimated(smooth, spiky, 2000);
  EXPECT_LE(rows.size(), 2000U);
  EXPECT_GE(rows.size(), 2U * 333U) << "a smallest and a largest of each of the 333 stretches";
  EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end()));
  EXPECT_EQ(std::adjacent_find(rows.begin(), rows.end()), rows.end()) << "no row twice";
  for (const std::size_t row : {std::size_t{0}, std::size_t{12'345}, std::size_t{54'321}, std::size_t{99'999}}) {
    EXPECT_TRUE(contains(rows, row)) << row;
  }
}

TEST(Decimation, NeverExceedsTheLimitAndKeepsExtremesOfNoise) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (const std::size_t count : {99U, 1000U, 12'347U}) {
    std::vector<double> a(count);
    std::vector<double> b(count);
    for (double& value : a) value = normal(random);
    for (double& value : b) value = normal(random);
    for (const std::size_t limit : {8U, 50U, 333U}) {
      const std::vector<std::size_t> rows = decimated(a, b, limit);
      EXPECT_LE(rows.size(), limit);
      for (const std::vector<double>* values : {&a, &b}) {
        const auto [lowest, highest] = std::minmax_element(values->begin(), values->end());
        EXPECT_TRUE(contains(rows, static_cast<std::size_t>(lowest - values->begin()))) << count << " " << limit;
        EXPECT_TRUE(contains(rows, static_cast<std::size_t>(highest - values->begin()))) << count << " " << limit;
      }
    }
  }
}

TEST(Decimation, GapsStayGapsAndDoNotHideTheirNeighbours) {
  std::vector<double> values(10'000, 1.0);
  for (std::size_t k = 4000; k < 4100; ++k) values[k] = gap;
  values[4150] = 9.0;
  const std::vector<std::size_t> rows = decimated(values, values, 200);
  EXPECT_TRUE(std::any_of(rows.begin(), rows.end(), [&](std::size_t row) { return std::isnan(values[row]); }));
  EXPECT_TRUE(contains(rows, 4150));
}

TEST(Decimation, ACloudKeepsItsExtremesAndItsDensity) {
  std::vector<double> y(50'000, 0.0);
  y[31'000] = 5.0;
  const std::vector<std::size_t> rows = thinned_cloud(y, 1000);
  EXPECT_LE(rows.size(), 1000U);
  EXPECT_TRUE(contains(rows, 31'000));
  const auto first_half = std::lower_bound(rows.begin(), rows.end(), 25'000U) - rows.begin();
  EXPECT_NEAR(static_cast<double>(first_half) / static_cast<double>(rows.size()), 0.5, 0.05);
}

}  // namespace
}  // namespace host
