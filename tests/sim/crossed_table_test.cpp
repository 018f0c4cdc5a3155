// The table of two crossed axes against closed forms of each error, and the ballbar's setting and noise.
#include "sim/crossed_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

constexpr double kPeriod_s = 1e-3;

/// Catches an error on the wrong axis, in a wrong unit, or not about the centre.
TEST(CrossedTable, DisplacesByEachErrorAlone) {
  sim::CrossedTableErrors errors;
  errors.squareness_um_m = 200.0;
  EXPECT_NEAR(sim::CrossedTable(errors).moved_to({5.0, 50.0}, kPeriod_s)[0], 5.01, 1e-12);
  EXPECT_NEAR(sim::CrossedTable(errors).moved_to({5.0, 50.0}, kPeriod_s)[1], 50.0, 1e-12);
  errors = {};
  errors.axis[1].scale_ppm = -100.0;
  EXPECT_NEAR(sim::CrossedTable(errors).moved_to({5.0, 50.0}, kPeriod_s)[1], 49.995, 1e-12);
  errors = {};
  errors.centre_mm = {20.0, 0.0};
  errors.axis[0].bow_um = 8.0;
  EXPECT_NEAR(sim::CrossedTable(errors).moved_to({20.0, 1.0}, kPeriod_s)[1], 1.0, 1e-12);
  for (const double x : {-30.0, 70.0})
    EXPECT_NEAR(sim::CrossedTable(errors).moved_to({x, 1.0}, kPeriod_s)[1], 1.002, 1e-12);
}

/// Catches play that is not taken up after a reversal, or to the wrong side.
TEST(CrossedTable, LeansToTheSideOfItsMotion) {
  sim::CrossedTableErrors errors;
  errors.axis[1].play_um = 6.0;
  sim::CrossedTable table(errors);
  double y = 0.0;
  table.moved_to({0.0, y}, kPeriod_s);
  const auto lean_um = [&](double by_mm) {
    for (int k = 0; k < 100; ++k) table.moved_to({0.0, y += by_mm / 100.0}, kPeriod_s);
    return 1e3 * table.moved_to({0.0, y}, kPeriod_s)[0];
  };
  EXPECT_NEAR(lean_um(1.0), 3.0, 1e-9);
  EXPECT_NEAR(lean_um(-0.005), 0.0, 1e-9) << "half of the way";
  EXPECT_NEAR(lean_um(-1.0), -3.0, 1e-9);
}

TEST(CrossedTable, YieldsToTheAccelerationOfTheOtherAxis) {
  sim::CrossedTableErrors errors;
  errors.axis[0].coupling_um_s2_m = 20.0;
  sim::CrossedTable table(errors);
  double y = 0.0;
  for (int k = 0; k < 10; ++k) y = table.moved_to({0.5 * 400.0 * std::pow(k * kPeriod_s, 2), 0.0}, kPeriod_s)[1];
  EXPECT_NEAR(y, 0.008, 1e-9) << "0.4 m/s^2";
}

TEST(Ballbar, HasItsOwnCentreLengthAndNoise) {
  sim::Ballbar exact({{30.0, 40.0}, -7.0, 0.0}, {10.0, 20.0}, 1);
  EXPECT_NEAR(exact.read({10.0, 20.0}), 0.05 - 0.007, 1e-12);
  sim::Ballbar noisy({{}, 0.0, 0.2}, {}, 1);
  double sum = 0.0, squares = 0.0;
  constexpr int kReadings = 20'000;
  for (int k = 0; k < kReadings; ++k) {
    const double off_um = 1e3 * (noisy.read({30.0, 40.0}) - 50.0);
    sum += off_um;
    squares += off_um * off_um;
  }
  EXPECT_NEAR(sum / kReadings, 0.0, 0.006);  // four standard deviations of the mean
  EXPECT_NEAR(std::sqrt(squares / kReadings), 0.2, 0.004);
}

}  // namespace
