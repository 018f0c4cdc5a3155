// Contour error of a completed path, from rows made here.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/device/path_run.hpp"

namespace {

constexpr double kCount_mm = 0.00244140625, kRow_s = 0.001, kFrom_s = 2.0, kTo_s = 6.0;

/// A circle of 11 s at 20 mm/s, as captured by encoders, with missing rows.
TEST(ContourError, RowsThatWereLostAreNoError) {
  host::PathMove move;
  move.curve = host::PathCurve::arc({0, 0, 0}, {35, 0, 0}, 2 * std::numbers::pi, 0);
  move.feed_mm_s = 20.0;
  host::PathPlanOptions options;
  options.limits = {host::PathPoint::Constant(250.0), host::PathPoint::Constant(2000.0),
                    host::PathPoint::Constant(50'000.0)};
  const host::PlannedPath path = host::plan_path({move}, options);
  host::PathCapture capture;
  capture.row_period_s = kRow_s;
  capture.mm.resize(2);
  capture.reference_mm.resize(2);
  std::size_t knot = 0;
  for (std::uint32_t row = 0; row * kRow_s < path.duration_s(); ++row) {
    const double time_s = row * kRow_s;
    while (path.knots[knot + 1].time_s < time_s) ++knot;
    if (time_s > kFrom_s && time_s < kTo_s) continue;
    const host::PathPoint at = between(path.knots[knot], path.knots[knot + 1], time_s).position;
    capture.number.push_back(row);
    for (Eigen::Index i = 0; i < 2; ++i) {
      capture.reference_mm[static_cast<std::size_t>(i)].push_back(at[i]);
      capture.mm[static_cast<std::size_t>(i)].push_back(kCount_mm * std::floor(at[i] / kCount_mm));
    }
  }
  const host::PathScale scale{{0, 1}, {kCount_mm, kCount_mm}, {1.0, 1.0}, 1.0 / kRow_s};
  for (const double error_um : contour_error_um(capture, path, scale)) ASSERT_LT(error_um, 1e3 * kCount_mm);
}

/// References are rounded down, as on a board. Near the reversal, the nearest point of the plan is then before it.
TEST(ContourError, ALineThereAndBackEndsWhereItBegan) {
  host::PathMove there, back;
  there.curve = host::PathCurve::line({0, 0, 0}, {60, 60, 0});
  back.curve = host::PathCurve::line({60, 60, 0}, {0, 0, 0});
  there.feed_mm_s = back.feed_mm_s = 50.0;
  host::PathPlanOptions options;
  options.limits = {host::PathPoint::Constant(250.0), host::PathPoint::Constant(1500.0),
                    host::PathPoint::Constant(20'000.0)};
  const host::PlannedPath path = host::plan_path({there, back}, options);
  for (const double rounding_mm : {1e-7, 2e-6, 1e-5}) {
    host::PathCapture capture;
    capture.row_period_s = kRow_s;
    capture.mm.resize(2);
    capture.reference_mm.resize(2);
    std::size_t knot = 0;
    for (std::uint32_t row = 0; (row + 0.37) * kRow_s < path.duration_s(); ++row) {
      const double time_s = (row + 0.37) * kRow_s;
      while (path.knots[knot + 1].time_s < time_s) ++knot;
      const host::PathPoint at = between(path.knots[knot], path.knots[knot + 1], time_s).position;
      capture.number.push_back(row);
      for (Eigen::Index i = 0; i < 2; ++i) {
        capture.reference_mm[static_cast<std::size_t>(i)].push_back(rounding_mm * std::floor(at[i] / rounding_mm));
        capture.mm[static_cast<std::size_t>(i)].push_back(kCount_mm * std::floor(at[i] / kCount_mm));
      }
    }
    const host::PathScale scale{{0, 1}, {kCount_mm, kCount_mm}, {1.0, 1.0}, 1.0 / kRow_s};
    for (const double error_um : contour_error_um(capture, path, scale))
      ASSERT_LT(error_um, 1e3 * kCount_mm) << rounding_mm;
  }
}

}  // namespace
