// Lines and circles of two unequal axes over the board's protocol, on a simulated board with the parameter files of
// `design`, with each axis's best loop and with one loop for both. Computes the errors from the captured encoder
// positions. Catches parameters that are lost or mixed up between the design and the board, and axes that are not
// synchronised.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "host/parameters/design_file.hpp"
#include "tests/guest/support/path_in_process.hpp"
#include "tests/host/axes/unlike_axes.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using axes_test::kCount_um;

class MatchedBoard : public testing::TestWithParam<bool> {
 protected:
  std::vector<std::string> files_of(const host::LoopSet& set, const std::string& of) const {
    std::vector<std::string> files;
    for (const host::AxisLoop& loop : set.axes)
      files.push_back(folder_.write(of + loop.model.name + ".toml",
                                    host::design_toml(loop.model, loop.design, loop.filters, loop.limits.written)));
    return files;
  }

  static guest_test::PathInProcess follow(const std::vector<std::string>& files, const std::string& program) {
    guest_test::PathInProcess done =
        guest_test::follow_in_process({axes_test::machine()[0].model, axes_test::machine()[1].model}, files, program);
    EXPECT_EQ(static_cast<firmware::PathEnd>(done.outcome.state.end), firmware::PathEnd::completed);
    EXPECT_EQ(done.capture.lost, 0u);
    return done;
  }

  TemporaryFolder folder_;
  const host::MachineDesign design_ = axes_test::designed(axes_test::machine(), GetParam());
  const std::vector<std::string> own_ = files_of(design_.own, "own-"), matched_ = files_of(design_.matched, "matched-");
};

constexpr double kLength_mm = 90.0, kEnds_mm = 1.0;

/// Largest distance from a line, forth and back, without its ends, where friction dominates. The contour error reported
/// by `run` must be the same.
std::array<double, 2> line_errors_um(const guest_test::PathInProcess& done, double angle) {
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

/// The rows of the last four full turns, all of which must be at the feed. A fraction of a turn would contain more
/// reversals of one axis than of the other.
std::pair<std::size_t, std::size_t> four_turns(const host::PathCapture& capture, double radius, double feed_mm_s) {
  const auto is_at_feed = [&](std::size_t k) {
    const double x = capture.reference_mm[0][k] - capture.reference_mm[0][k - 1];
    const double y = capture.reference_mm[1][k] - capture.reference_mm[1][k - 1];
    return std::hypot(x, y) > 0.998 * feed_mm_s * capture.row_period_s;
  };
  std::size_t last = capture.number.size() - 1;
  while (last > 0 && !is_at_feed(last)) --last;
  const auto rows = static_cast<std::size_t>(8.0 * std::numbers::pi * radius / feed_mm_s / capture.row_period_s);
  if (last < rows) {
    ADD_FAILURE() << "four turns at " << feed_mm_s << " mm/s take more than " << last << " rows";
    return {1, 1};
  }
  for (std::size_t k = last - rows; k < last; ++k)
    if (!is_at_feed(k)) ADD_FAILURE() << "slower than " << feed_mm_s << " mm/s in row " << k;
  return {last - rows, last};
}

TEST_P(MatchedBoard, KeepsLinesStraight) {
  for (const double feed : {50.0, 100.0, 200.0})
    for (const double angle_deg : {15.0, 45.0, 75.0}) {
      const double angle = angle_deg * std::numbers::pi / 180.0;
      char program[200];
      std::snprintf(program, sizeof program, "F%.0f G1 X%.4f Y%.4f\nG1 X0 Y0\nM2\n", 60.0 * feed,
                    kLength_mm * std::cos(angle), kLength_mm * std::sin(angle));
      const auto own = line_errors_um(follow(own_, program), angle);
      const auto matched = line_errors_um(follow(matched_, program), angle);
      for (const std::size_t way : {0u, 1u}) {
        std::printf("%s, %3.0f mm/s, %2.0f degrees%s: own %6.2f um, matched %5.2f um\n",
                    GetParam() ? "zero phase" : "velocity", feed, angle_deg, way == 1 ? " back" : "", own[way],
                    matched[way]);
        if (!GetParam() && angle_deg == 45.0) {
          EXPECT_LE(matched[way], own[way] / 5.0) << feed;
        }
        EXPECT_LE(matched[way], own[way] + kCount_um) << feed << ' ' << angle_deg;
      }
    }
}

TEST_P(MatchedBoard, KeepsCirclesRound) {
  const double radius = 35.0;
  // At 160 mm/s y reaches its limit of acceleration where it reverses: the path slows down there, and the circle's
  // radius depends on the feed.
  for (const double feed : {50.0, 150.0})
    for (const char* word : {"G2", "G3"}) {
      char turn[100];
      std::snprintf(turn, sizeof turn, "%s X0 Y0 I%.0f J0\n", word, radius);
      std::string program = "F" + std::to_string(static_cast<int>(60.0 * feed)) + "\n";
      for (int turns = 0; turns < 6; ++turns) program += turn;
      program += "M2\n";
      const auto ellipse_um = [&](const std::vector<std::string>& files) {
        const host::PathCapture capture = follow(files, program).capture;
        const auto [first, last] = four_turns(capture, radius, feed);
        axes_test::EllipseFit fit(radius);
        for (std::size_t k = first; k < last; ++k)
          fit.add(capture.mm[0][k] + kCount_um / 2e3 - radius, capture.mm[1][k] + kCount_um / 2e3);
        return fit.um();
      };
      const double own = ellipse_um(own_), matched = ellipse_um(matched_);
      std::printf("%s, %3.0f mm/s, %s: ellipse own %6.2f um, matched %5.2f um\n",
                  GetParam() ? "zero phase" : "velocity", feed, word, own, matched);
      EXPECT_LE(matched, 0.5) << feed << ' ' << word;
    }
}

INSTANTIATE_TEST_SUITE_P(Feedforward, MatchedBoard, testing::Values(true, false),
                         [](const auto& which) { return which.param ? "ZeroPhase" : "Velocity"; });

}  // namespace
