// The formulas of a stop against integrated equations of motion.
#include "host/parameters/stopping_way.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/identify/paper_drives.hpp"

namespace {

using host::StoppingFigures;
using host::StoppingWay;

constexpr StoppingFigures kLight{
    .inertia = 0.010, .friction = 0.2, .lead = 1.5915, .deceleration = 2000.0, .jerk = 50000.0};

/// Integrates in steps of 10 us; `effort`: torque against the motion over time, Nm.
template <typename Effort>
StoppingWay integrated(const StoppingFigures& axis, double speed, Effort effort) {
  constexpr double kStep_s = 1e-5;
  StoppingWay way;
  for (double v = speed; v > 0.0 && way.time_s < 30.0; way.time_s += kStep_s) {
    way.travel += v * kStep_s;
    v -= effort(way.time_s) * axis.lead / axis.inertia * kStep_s;
  }
  return way;
}

TEST(StoppingWay, ALightAxisCoastsAMetre) {
  const StoppingWay way = host::drop_way(kLight, 250.0);
  const StoppingWay truth = integrated(kLight, 250.0, [](double) { return kLight.friction; });
  EXPECT_NEAR(way.travel, truth.travel, 1e-3 * truth.travel);
  EXPECT_NEAR(way.time_s, truth.time_s, 1e-3 * truth.time_s);
  EXPECT_NEAR(way.travel, 981.7, 1.0) << "the README says so";
}

TEST(StoppingWay, AHangingAxisFallsUntilItsBrakeHolds) {
  StoppingFigures axis = kLight;
  axis.weight = 3.0;
  EXPECT_TRUE(std::isinf(host::drop_way(axis, 100.0).travel)) << "nothing stops it";
  axis.brake = true;
  axis.brake_time_s = 0.1;
  EXPECT_TRUE(std::isinf(host::drop_way(axis, 100.0).travel)) << "a brake of unknown effort does not";
  axis.brake_effort = 20.0;
  for (const double speed : {1.0, 50.0, 250.0}) {
    const StoppingWay truth = integrated(axis, speed, [](double t) { return t < 0.1 ? 0.2 - 3.0 : 20.0 + 0.2 - 3.0; });
    EXPECT_NEAR(host::drop_way(axis, speed).travel, truth.travel, 2e-3 * truth.travel) << speed;
  }
}

TEST(StoppingWay, ARampIsLimitedInJerk) {
  // v(t) of a stop from rest of acceleration: jerk up, steady, jerk down.
  for (const double speed : {50.0, 120.0, 250.0}) {
    double v = speed, a = 0.0, travel = 0.0;
    constexpr double kStep_s = 1e-6;
    while (v > 0.0) {
      const bool must_ease = v <= a * a / (2.0 * kLight.jerk);
      a = std::clamp(a + (must_ease ? -1.0 : 1.0) * kLight.jerk * kStep_s, 1.0, kLight.deceleration);
      travel += v * kStep_s;
      v -= a * kStep_s;
    }
    const double way = host::ramp_way(kLight, speed).travel;
    EXPECT_GE(way, travel - 0.01) << speed;
    EXPECT_LE(way, travel + 1.0) << speed;
  }
}

TEST(StoppingWay, ADropDuringTheRampIsBetweenBoth) {
  const double ramp = host::ramp_way(kLight, 250.0).travel, drop = host::drop_way(kLight, 250.0).travel;
  double before = ramp;
  for (const double at : {50.0, 100.0, 200.0, 250.0}) {
    const double way = host::broken_ramp_way(kLight, 250.0, 250.0, at, 0.0).travel;
    EXPECT_GT(way, before);
    EXPECT_LE(way, drop + 250.0 * 0.04 / 2.0 + 1e-9);
    before = way;
  }
}

TEST(StoppingWay, TakesTheLeastFrictionOfTheModel) {
  const auto drive = *host::paper_drive("x");
  const StoppingFigures axis = host::stopping_figures(drive, 250.0, 2000.0, 50000.0);
  EXPECT_DOUBLE_EQ(axis.inertia, 0.00765);
  EXPECT_LE(axis.friction, 1.656);
  EXPECT_GT(axis.friction, 1.5);
  EXPECT_NEAR(host::drop_way(axis, 250.0).travel, 91.0, 3.0) << "the README says so";
}

}  // namespace
