// The tests must name the coordinate on which a made residual depends, and none if the residual is independent.
#include "host/compare/residual_tests.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "tests/host/evidence/hand_made_record.hpp"

namespace {

/// A record whose motor gave `extra` (Nm; a function of time, travel and speed) beyond the torque that its motion
/// needs.
host::Record record_with(const std::function<double(double t_s, double x, double w)>& extra) {
  host::Record record = HandMade::record(20.0);
  const double per_volt = HandMade::model().data.effort_per_volt();
  for (std::size_t k = 0; k < record.size(); ++k)
    record.u_V[k] += extra(record.t_s[k], record.x[k], record.w[k]) / per_volt;
  return record;
}

double share_on(const host::ResidualTests& tests, const std::string& coordinate) {
  for (const host::ResidualDependence& dependence : tests.dependences)
    if (dependence.coordinate == coordinate) return dependence.share;
  return -1.0;
}

host::ResidualTests tests_of(const host::Record& record) {
  const host::RecordSet set = host::compare_on({&record}, HandMade::model());
  return host::test_residuals(HandMade::model(), set, set);
}

TEST(ResidualTests, ATorqueOfAFixedFrequencyIsNamedByItsFrequency) {
  constexpr double kHum_Hz = 17.0;  // within the resolution of the smoother
  const auto tests = tests_of(
      record_with([](double t_s, double, double) { return 0.2 * std::sin(2.0 * std::numbers::pi * kHum_Hz * t_s); }));
  ASSERT_FALSE(tests.dependences.empty());
  EXPECT_EQ(tests.dependences.front().coordinate, "frequency");
  double found_Hz = 0.0;
  ASSERT_EQ(std::sscanf(tests.dependences.front().where.c_str(), "at %lf Hz", &found_Hz), 1);
  EXPECT_NEAR(found_Hz, kHum_Hz, 0.51);  // lines are 0.5 Hz apart
  EXPECT_GT(tests.dependences.front().share, 0.5);
}

TEST(ResidualTests, AFrictionThatTheModelLacksIsNamedByTheSpeed) {
  const auto tests = tests_of(record_with([](double, double, double w) { return 0.004 * w * std::abs(w) / 10.0; }));
  EXPECT_GT(share_on(tests, "speed"), 0.5);
  EXPECT_LT(share_on(tests, "frequency"), 0.1);
}

TEST(ResidualTests, AHardSpotIsNamedByItsPositionAlthoughItTurnsWithTheDirection) {
  const auto tests = tests_of(record_with([](double, double x, double w) {
    const double distance = (x - 30.0) / 8.0;
    return std::abs(w) > 1.0 ? std::copysign(0.4, w) * std::exp(-distance * distance) : 0.0;
  }));
  EXPECT_GT(share_on(tests, "position"), 0.1);
}

/// Catches a test that includes samples at rest, in which nothing decays.
TEST(ResidualTests, WhatFadesSoonAfterAReversalIsFoundNearReversals) {
  constexpr double kFades_mm = 0.03;
  double turned = 0.0, before = 0.0, last_x = 0.0;
  const auto fading = tests_of(record_with([&](double, double x, double w) {
    if (w * before < 0.0) turned = last_x;
    if (w != 0.0) before = w;
    last_x = x;
    return -0.5 * std::copysign(std::exp(-std::abs(x - turned) / kFades_mm), w);
  }));
  EXPECT_GT(fading.near_reversals, 0.65);  // 0.54 if samples at rest counted too
  const auto at_speed = tests_of(record_with([](double, double, double w) { return 0.004 * w * std::abs(w) / 10.0; }));
  EXPECT_LT(at_speed.near_reversals, 0.35);  // 0.25 if it were spread evenly
}

TEST(ResidualTests, TheAutocorrelationBeginsAtOneAndHasABound) {
  const auto tests = tests_of(record_with([](double t_s, double, double) { return 0.1 * std::sin(30.0 * t_s); }));
  ASSERT_FALSE(tests.with_itself.value.empty());
  EXPECT_NEAR(tests.with_itself.value.front(), 1.0, 1e-9);
  EXPECT_GT(tests.with_itself.bound, 0.0);
  EXPECT_LT(tests.with_itself.bound, 0.2);
  // A sine of 30 rad/s reverses after 0.105 s, which is longer than a window of 0.1 s, so that restarts do not hide it.
  double least = 1.0;
  for (const double value : tests.with_itself.value) least = std::min(least, value);
  EXPECT_LT(least, -tests.with_itself.bound);
}

TEST(ResidualTests, AFrictionThatDriftsIsSlow) {
  const auto tests =
      tests_of(record_with([](double t_s, double, double w) { return (w > 0.0 ? 0.2 : -0.2) * std::cos(0.3 * t_s); }));
  double slow = 0.0;
  for (const host::ResidualDependence& dependence : tests.dependences)
    if (dependence.coordinate == "time") slow = dependence.in_detail;
  EXPECT_GT(slow, 0.5);
  EXPECT_LT(tests.constant, 0.2);
}

/// Reading of the speed channel, as a function of the true speed, its acceleration and the travel.
using Reading = std::function<double(double w, double acceleration, double x_mm)>;

host::ResidualTests tests_of_reading(const Reading& reading) {
  host::Record record = HandMade::record(20.0);
  for (std::size_t k = 0; k < record.size(); ++k)
    record.w[k] = reading(record.w[k], HandMade::acceleration(record.t_s[k]), record.x[k]);
  const host::RecordSet set = host::compare_on({&record}, HandMade::model());
  return host::test_speed_channel(HandMade::model(), set, set);
}

TEST(SpeedChannel, IsHeldAgainstTheMotionOfThePosition) {
  const auto gain = tests_of_reading([](double w, double, double) { return 1.05 * w; });
  EXPECT_EQ(gain.dependences.front().coordinate, "speed");
  EXPECT_GT(share_on(gain, "speed"), 0.9);
  const auto lag = tests_of_reading([](double w, double a, double) { return w - 0.004 * a; });
  EXPECT_EQ(lag.dependences.front().coordinate, "acceleration");
  const auto ripple = tests_of_reading(
      [](double w, double, double x_mm) { return w * (1.0 + 0.03 * std::cos(2.0 * std::numbers::pi * x_mm / 5.0)); });
  EXPECT_EQ(ripple.dependences.front().coordinate, "position");
  const auto offset = tests_of_reading([](double w, double, double) { return w + 0.5; });
  EXPECT_GT(offset.constant, 0.8);
}

}  // namespace
