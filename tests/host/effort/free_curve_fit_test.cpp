// Free curves for effects that the formulas of the base cannot explain, on torques in closed form.
#include "host/effort/free_curve_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/curve.hpp"
#include "tests/host/diagnose/drive_case.hpp"
#include "tests/host/effort/made_effort.hpp"
#include "tests/host/skip_where_instrumented.hpp"

namespace {

template <typename Further>
host::EffortScreen screen_of(Further further, double train_s = 20.0) {
  const host::Record train = record_of(slow_turning, further, 0.0, train_s, 1);
  const host::Record validate = record_of(slow_turning, further, 23.0, 36.0, 2);
  const sim::DriveDescription model = motor();
  return host::screen_effort(model, host::compare_on({&train}, model), host::compare_on({&validate}, model), 0);
}

double taken(const host::EffortScreen& screen, const host::FreeCurveFit& fit) {
  return 1.0 - std::pow(fit.model.validate / screen.best().validate, 2);
}

std::vector<const host::Record*> addresses(const std::vector<host::Record>& records) {
  std::vector<const host::Record*> result;
  for (const host::Record& record : records) result.push_back(&record);
  return result;
}

/// A notch that repeats every 0.8 mm and is not a sine.
double notched(const Point& point) {
  const double phase = point.x / 0.8 - std::floor(point.x / 0.8);
  return phase < 0.25 ? 0.03 : 0.0;
}

// A curve over the whole travel would need knots for each of the forty notches.
TEST(FreeCurve, OverPhaseCarriesWhatComesBackAndGivesItsPeriod) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const host::EffortScreen screen = screen_of(notched);
  const std::optional<host::FreeCurveFit> fit = host::fit_free_curve(screen);
  ASSERT_TRUE(fit.has_value());
  EXPECT_EQ(fit->over, "phase");
  EXPECT_NEAR(fit->period, 0.8, 0.008);
  EXPECT_GT(taken(screen, *fit), 0.8);
  const sim::Curve curve(fit->model.model.effects.back());
  EXPECT_EQ(curve.values().front(), curve.values().back());
  EXPECT_NEAR(curve(0.1) - curve(0.5), 0.03, 0.005);
  EXPECT_NEAR(curve(0.1), curve(0.1 - 3.0 * curve.period()), 1e-9);
}

TEST(FreeCurve, FindsNoPhaseInWhatGoesAlongTheTravelOnce) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const host::EffortScreen screen = screen_of([](const Point& point) { return 0.03 * std::exp(-point.x * point.x); });
  EXPECT_FALSE(host::fit_free_curve(screen, "phase").has_value());
  const std::optional<host::FreeCurveFit> fit = host::fit_free_curve(screen);
  ASSERT_TRUE(fit.has_value());
  EXPECT_EQ(fit->over, "position");
}

// If a curve over the current were fitted together with a free inertia, it would absorb the whole inertia.
TEST(FreeCurve, OverCurrentLeavesTheInertia) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  DriveCase dead_zone("single/case-09");
  const host::PreparedSets sets =
      host::split_sets(dead_zone.model, addresses(dead_zone.train), addresses(dead_zone.validate));
  const host::EffortScreen screen = host::screen_effort(dead_zone.model, sets.training, sets.validation, 0);
  const std::optional<host::FreeCurveFit> fit = host::fit_free_curve(screen, "current");
  ASSERT_TRUE(fit.has_value());
  EXPECT_EQ(fit->model.model.find("inertia")->at("J"), screen.base.model.find("inertia")->at("J"));
}

}  // namespace
