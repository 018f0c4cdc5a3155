// Pages of scenarios: the magnified circle, before and after on one page, an index of several scenarios.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/hil/before_after_report.hpp"
#include "host/hil/circle_plot.hpp"
#include "host/hil/scenario_index.hpp"

namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double kRadius = 20.0;  // mm

host::Scenario scenario_along(const host::Path& path) {
  host::Scenario scenario;
  scenario.path = "s.toml";
  scenario.name = "a path";
  host::ScenarioMove move;
  move.kind = host::MoveKind::circle;
  move.path = path;
  scenario.moves.push_back(move);
  return scenario;
}

/// Radius too large by 8 um towards +X, too small by 3 um towards +Y.
host::ScenarioRun run_by_hand() {
  host::ScenarioRun run;
  for (int k = 0; k < 360; ++k) {
    const double angle = k * std::numbers::pi / 180.0;
    const double r = kRadius + (k == 0 ? 0.008 : k == 90 ? -0.003 : 0.0);
    run.path_points.push_back({kRadius + r * std::cos(angle), r * std::sin(angle)});
    run.contour_um.push_back(k == 0 ? 8.0 : k == 90 ? 3.0 : 0.0);
  }
  for (std::size_t i = 0; i < hal::kAxisCount; ++i) {
    run.tracking_um[i].assign(360, 1.0);
    run.records[i].t_s.resize(360);
    for (int k = 0; k < 360; ++k) run.records[i].t_s[static_cast<std::size_t>(k)] = 0.001 * k;
  }
  return run;
}

TEST(CirclePlot, SaysHowFarOutsideTheCircleAndWhere) {
  const host::ScenarioRun run = run_by_hand();
  const auto plot =
      host::circle_plot(scenario_along(host::Path::circle(kRadius)), {{"encoders", host::SeriesRole::before, &run}});
  ASSERT_TRUE(plot);
  EXPECT_DOUBLE_EQ(plot->radius_mm, kRadius);
  ASSERT_EQ(plot->traces.size(), 1u);
  EXPECT_NEAR(plot->traces[0].deviation_um[0], 8.0, 1e-9);
  EXPECT_NEAR(plot->traces[0].deviation_um[90], -3.0, 1e-9);
  EXPECT_NEAR(plot->traces[0].angle_rad[90], std::numbers::pi / 2, 1e-9);
}

TEST(CirclePlot, ASquareHasNone) {
  const host::ScenarioRun run = run_by_hand();
  EXPECT_FALSE(host::circle_plot(scenario_along(host::Path::rounded_square(40.0, 8.0)),
                                 {{"encoders", host::SeriesRole::before, &run}}));
}

TEST(BeforeAfterReport, SaysWhatBecameOfTheErrorInItsHeadline) {
  const host::ScenarioRun before = run_by_hand();
  host::ScenarioRun after = run_by_hand();
  for (double& value : after.contour_um) value /= 4.0;
  EXPECT_EQ(host::before_and_after(before, after), "contour error 8.00 → 2.00 µm");
  const host::Scenario scenario = scenario_along(host::Path::circle(kRadius));
  const std::string page = host::before_after_report(scenario, before, after, {}).html();
  EXPECT_THAT(page, HasSubstr("<h2>Contour error 8.00 → 2.00 µm</h2>"));
  EXPECT_THAT(page, HasSubstr("verdict good"));
  EXPECT_THAT(host::before_after_report(scenario, after, before, {}).html(), Not(HasSubstr("verdict good")));
}

TEST(ScenarioIndex, CountsAndNamesWhatFailsFirst) {
  const std::vector<host::IndexLine> lines = {{"good.html", "g", "fine", true, false},
                                              {"wish.html", "w", "nearly", true, true},
                                              {"bad one.html", "b", "too far", false, false}};
  const host::Verdict verdict = host::index_verdict(lines);
  EXPECT_EQ(verdict.headline, "2 of 3 scenarios hold");
  EXPECT_EQ(verdict.tone, host::Tone::bad);
  EXPECT_THAT(verdict.sentences, testing::ElementsAre("wish misses its target: nearly.", "bad one FAILS: too far."));
  const std::string page = host::scenario_index(lines).html();
  const auto at = [&page](const char* link) { return page.find(std::string("<a href=\"") + link); };
  EXPECT_LT(at("bad one.html"), at("wish.html"));
  EXPECT_LT(at("wish.html"), at("good.html"));
  EXPECT_NE(at("good.html"), std::string::npos);
}

}  // namespace
