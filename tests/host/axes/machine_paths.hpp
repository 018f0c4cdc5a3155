// Lines and circles of two axes on a board, and their errors from the captured encoder positions.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "tests/guest/support/path_in_process.hpp"
#include "tests/host/axes/unlike_axes.hpp"

namespace axes_test {

inline constexpr double kLength_mm = 90.0, kEnds_mm = 1.0;

/// Largest distance from a line, forth and back, without its ends, where friction dominates. The contour error reported
/// by `run` must be the same.
inline std::array<double, 2> line_errors_um(const guest_test::PathInProcess& done, double angle) {
  const host::PathCapture& capture = done.capture;
  const std::vector<double> told_um = host::contour_error_um(capture, done.path, done.machine.scale);
  double most_told_um = 0.0;
  const double c = std::cos(angle), s = std::sin(angle);
  std::array<double, 2> most{};
  bool is_back = false;
  for (std::size_t k = 0; k < capture.number.size(); ++k) {
    const double along = c * capture.reference_mm[0][k] + s * capture.reference_mm[1][k];
    is_back = is_back || along > kLength_mm - 1e-3;
    if (along < kEnds_mm || along > kLength_mm - kEnds_mm) continue;
    const double off = c * (capture.mm[1][k] + kCount_um / 2e3) - s * (capture.mm[0][k] + kCount_um / 2e3);
    most[is_back ? 1 : 0] = std::max(most[is_back ? 1 : 0], std::abs(1e3 * off));
    most_told_um = std::max(most_told_um, told_um[k]);
  }
  EXPECT_NEAR(most_told_um, std::max(most[0], most[1]), 0.5);
  return most;
}

/// The rows of the last four full turns at the feed. A fraction of a turn would contain more reversals of one axis than
/// of the other.
inline std::pair<std::size_t, std::size_t> four_turns(const host::PathCapture& capture, double radius,
                                                      double feed_mm_s) {
  const auto is_at_feed = [&](std::size_t k) {
    const double x = capture.reference_mm[0][k] - capture.reference_mm[0][k - 1];
    const double y = capture.reference_mm[1][k] - capture.reference_mm[1][k - 1];
    return std::hypot(x, y) > 0.998 * feed_mm_s * capture.row_period_s;
  };
  const auto rows = static_cast<std::size_t>(8.0 * std::numbers::pi * radius / feed_mm_s / capture.row_period_s);
  std::size_t steady = 0;
  for (std::size_t k = capture.number.size() - 1; k > 0; --k) {
    steady = is_at_feed(k) ? steady + 1 : 0;
    if (steady == rows) return {k, k + rows};
  }
  ADD_FAILURE() << "no four turns at " << feed_mm_s << " mm/s";
  return {1, 1};
}

/// Forth and back.
inline std::string line_program(double angle, double feed_mm_s) {
  return fmt::format("F{:.0f} G1 X{:.4f} Y{:.4f}\nG1 X0 Y0\nM2\n", 60.0 * feed_mm_s, kLength_mm * std::cos(angle),
                     kLength_mm * std::sin(angle));
}

/// Six turns.
inline std::string circle_program(const char* word, double radius_mm, double feed_mm_s) {
  std::string program = fmt::format("F{:.0f}\n", 60.0 * feed_mm_s);
  for (int turn = 0; turn < 6; ++turn) program += fmt::format("{} X0 Y0 I{:.0f} J0\n", word, radius_mm);
  return program + "M2\n";
}

/// Difference of the half axes of the circle's ellipse.
inline double ellipse_um(const host::PathCapture& capture, double radius_mm, double feed_mm_s) {
  const auto [first, last] = four_turns(capture, radius_mm, feed_mm_s);
  EllipseFit fit(radius_mm);
  for (std::size_t k = first; k < last; ++k)
    fit.add(capture.mm[0][k] + kCount_um / 2e3 - radius_mm, capture.mm[1][k] + kCount_um / 2e3);
  return fit.um();
}

}  // namespace axes_test
