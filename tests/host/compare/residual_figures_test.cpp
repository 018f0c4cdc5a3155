// Figures of residuals that are known in closed form.
#include "host/compare/residual_figures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace host {
namespace {

constexpr double kPeriod_mm = 10.0;

/// Motion back and forth over 200 mm. The friction varies by 35 % of 2 Nm within each 10 mm.
ResidualEffort varying_friction() {
  ResidualEffort samples;
  for (int k = 0; k < 8000; ++k) {
    const double phase = std::fmod(0.0005 * k, 2.0);
    const double direction = phase < 1.0 ? 1.0 : -1.0;
    samples.record.push_back(0);
    samples.x.push_back(200.0 * (phase < 1.0 ? phase : 2.0 - phase));
    samples.w.push_back(direction * (5.0 + k % 7));
    samples.missing.push_back(-direction * 0.7 * std::sin(2.0 * std::numbers::pi * samples.x.back() / kPeriod_mm));
  }
  return samples;
}

double largest(const ScatterSeries& curve) {
  double most = 0.0;
  for (const double value : curve.y) most = std::max(most, std::abs(value));
  return most;
}

// Catches a mean over both directions, for which friction that varies along the travel is a flat line at zero.
TEST(DirectionCurves, ShowAFrictionThatVariesWithThePosition) {
  const ResidualEffort samples = varying_friction();
  ResidualCoordinate over = coordinate_of("position", sim::DriveKind::rotary, kPeriod_mm);
  over.folded = true;
  const std::vector<ScatterSeries> curves = direction_curves(samples, samples.missing, over);
  ASSERT_EQ(curves.size(), 2U);
  for (const ScatterSeries& curve : curves) EXPECT_NEAR(largest(curve), 0.7, 0.02);
  for (std::size_t k = 0; k < std::min(curves[0].x.size(), curves[1].x.size()); ++k)
    EXPECT_NEAR(curves[0].y[k], -curves[1].y[k], 0.1);
}

// Catches bins along the travel whose means beat with a known ripple. Eight bins per period show its full size.
TEST(DirectionCurves, AKnownRippleKeepsItsSizeAlongTheTravel) {
  const ResidualEffort samples = varying_friction();
  const auto along = coordinate_of("position", sim::DriveKind::rotary, kPeriod_mm);
  for (const ScatterSeries& curve : direction_curves(samples, samples.missing, along)) {
    EXPECT_GT(curve.x.size(), 100U);
    EXPECT_NEAR(largest(curve), 0.7, 0.08) << "a bin of an eighth of a period takes 3 % to 10 % of its top";
  }
}

TEST(ResidualCoordinate, TravelIsInMillimetresForBothKindsOfDrives) {
  ResidualEffort samples;
  samples.x = {0.25};
  EXPECT_EQ(coordinate_of("position", sim::DriveKind::linear).of(samples), std::vector{250.0});
  EXPECT_EQ(coordinate_of("position", sim::DriveKind::rotary).of(samples), std::vector{0.25});
  EXPECT_EQ(coordinate_of("position", sim::DriveKind::linear).axis.unit, "mm");
}

// A map shows the same position at different speeds in different cells, so friction is not averaged over both
// directions.
TEST(ResidualMaps, TellPositionAndSpeedApart) {
  const ResidualView view{"", SeriesRole::before, varying_friction(), {}};
  Report report("test");
  add_residual_maps(report, {&view, 1}, coordinate_of("position", sim::DriveKind::rotary, kPeriod_mm),
                    coordinate_of("speed", sim::DriveKind::rotary), sim::DriveKind::rotary);
  EXPECT_NE(report.html().find("\"kind\":\"map\""), std::string::npos);
}

// A chosen plot is the same curve as the fixed one over that coordinate; what cannot be drawn is said.
TEST(ChosenPlot, DrawsAnyQuantityOverAnyOther) {
  const auto plots = [](const std::pair<std::string, std::string>& names, double period) {
    const ResidualView view{"", SeriesRole::before, varying_friction(), {}};
    Report report("test");
    add_chosen_plot(report, {&view, 1}, names, sim::DriveKind::rotary, period);
    return report.html();
  };
  const ResidualView view{"", SeriesRole::before, varying_friction(), {}};
  Report fixed("test");
  add_residual_plot(fixed, coordinate_of("position", sim::DriveKind::rotary), "Missing torque against position",
                    {"missing torque", "Nm"}, {&view, 1}, &ResidualView::force, Layout::overlaid);
  EXPECT_EQ(plots({"position", "error"}, 0.0), fixed.html());
  EXPECT_NE(plots({"position", "speed"}, 0.0).find("Speed against position"), std::string::npos);
  EXPECT_NE(plots({"phase", "error"}, 0.0).find("not drawn"), std::string::npos);
  EXPECT_EQ(plots({"phase", "error"}, kPeriod_mm).find("not drawn"), std::string::npos);
  EXPECT_NE(plots({"temperature", "error"}, 0.0).find("not drawn"), std::string::npos) << "no record has one";
}

}  // namespace
}  // namespace host
