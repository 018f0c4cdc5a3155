// Planned paths, followed as on the board, stay within the limits and on the path, and are not slower than necessary.
#include "host/path/path_plan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>

#include "host/exit_codes.hpp"
#include "host/gcode/program.hpp"
#include "host/path/path_words.hpp"
#include "tests/host/path/random_programs.hpp"

namespace {

using namespace path_test;  // NOLINT(google-build-using-namespace)

/// Positions of both axes at each sample, by the board's own follower.
std::vector<PathPoint> followed(const host::PlannedPath& path) {
  const host::PathScale scale{{0, 1}, {kCount_mm, kCount_mm}, {1.0, 1.0}, kRate_Hz};
  const host::PathWords words = path_words(path, scale, units_of(path, scale), {{}, {}});
  auto follower = std::make_unique<firmware::PathFollower<2, 400>>();
  follower->open(3, words.units, {}, {board_limits(), board_limits()});
  LedAxes axes;
  std::vector<PathPoint> points(3, PathPoint::Zero());
  std::size_t sent = 0;
  do {
    for (; sent < words.nodes.size() && follower->room() > 0; ++sent) {
      const auto& word = words.nodes[sent];
      EXPECT_EQ(
          follower->push(node_of(word), sent + 1 == words.nodes.size(), [](std::size_t, std::int64_t) { return true; }),
          firmware::Refusal::none);
      if (testing::Test::HasFailure()) return points;
    }
    follower->prepare();
    if (points.size() == 3) follower->start();
    follower->before_step(axes);
    points.emplace_back(axes[0].mm(), axes[1].mm(), 0.0);
  } while (follower->is_moving());
  EXPECT_EQ(follower->end(), firmware::PathEnd::completed);
  points.insert(points.end(), 3, points.back());
  return points;
}

/// Time of a straight line of `length` mm: seven phases calculated by hand, with the clock's reserve.
double line_time(double length, double speed) {
  constexpr double kRate = firmware::kLeastHeadroom;
  const double acceleration = kAcceleration / (kRate * kRate), jerk = kJerk / (kRate * kRate * kRate);
  const auto ramp = [&](double v) {
    return v >= acceleration * acceleration / jerk ? v / acceleration + acceleration / jerk : 2.0 * std::sqrt(v / jerk);
  };
  if (speed * ramp(speed) <= length) return 2.0 * ramp(speed) + (length - speed * ramp(speed)) / speed;
  double low = 0.0, high = speed;
  for (int k = 0; k < 200; ++k)
    ((low + high) / 2.0 * ramp((low + high) / 2.0) <= length ? low : high) = (low + high) / 2.0;
  return 2.0 * ramp(low);
}

TEST(PlannedPath, LinesTakeTheShortestTimeThatTheirAxesAllow) {
  for (const double length : {0.01, 0.3, 4.0, 40.0, 400.0}) {
    const auto along = plan_path({move(PathCurve::line({0, 0, 0}, {length, 0, 0}), 1e9)}, options());
    EXPECT_NEAR(along.duration_s(), line_time(length, kVelocity), 3e-4 * along.duration_s());
    // The axes share the speed of a diagonal.
    const double side = length / std::numbers::sqrt2;
    const auto across = plan_path({move(PathCurve::line({0, 0, 0}, {side, side, 0}), 1e9)}, options());
    EXPECT_NEAR(across.duration_s(), line_time(side, kVelocity), 3e-4 * across.duration_s());
  }
}

/// Catches a planner that stops or reduces its acceleration where collinear lines meet.
TEST(PlannedPath, ALineInPiecesIsAsQuickAsTheWhole) {
  std::vector<PathMove> pieces;
  for (int k = 0; k < 200; ++k) pieces.push_back(move(PathCurve::line({0.2 * k, 0, 0}, {0.2 * (k + 1), 0, 0}), 120.0));
  const auto path = plan_path(pieces, options());
  EXPECT_NEAR(path.duration_s(), line_time(40.0, 120.0), 1e-3);
}

/// No circle can be quicker than a line of its length with the same feed.
TEST(PlannedPath, TheCirclesTimeIsWithinThreePercentOfALineOfItsLength) {
  const auto path = plan_path({move(PathCurve::arc({0, 0, 0}, {35, 0, 0}, 2 * std::numbers::pi, 0), 170.0)}, options());
  const double least = line_time(70.0 * std::numbers::pi, 170.0);
  EXPECT_GE(path.duration_s(), least);
  EXPECT_LE(path.duration_s(), 1.03 * least);
}

TEST(PlannedPath, ToleranceSavesTimeAtCorners) {
  const auto square = [](double tolerance_mm) {
    const PathPoint c[] = {{0, 0, 0}, {40, 0, 0}, {40, 40, 0}, {0, 40, 0}, {0, 0, 0}};
    std::vector<PathMove> moves;
    for (int i = 0; i < 4; ++i) moves.push_back(move(PathCurve::line(c[i], c[i + 1]), 100.0, tolerance_mm));
    return plan_path(moves, options()).duration_s();
  };
  EXPECT_NEAR(square(0.0), 4.0 * line_time(40.0, 100.0), 1e-3) << "exact corners are stops";
  EXPECT_LT(square(0.01), square(0.0) - 0.04);
  EXPECT_LT(square(0.1), square(0.01) - 0.03);
}

/// At a stop for the operator, the axes stand, and the following motion begins with a separate node.
TEST(PlannedPath, StopsForTheOperatorWhereTheProgramSaysSo) {
  const auto program =
      host::read_gcode("G64 P1\nG1 F600 X10\nM0\nX20\nM1\nX30\nM2\n", "part.ngc", PathPoint::Zero(), {});
  const auto path = plan_path(program.moves, options());
  ASSERT_EQ(path.stops.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_LT(path.stops[i].knot, path.knots.size() - 1);
    const host::PathKnot& knot = path.knots[path.stops[i].knot];
    EXPECT_EQ(path.stops[i].line, 3u + 2u * i);
    EXPECT_NEAR(knot.position[0], 10.0 * static_cast<double>(i + 1), 1e-9);
    EXPECT_EQ(knot.velocity.norm() + knot.acceleration.norm(), 0.0);
  }
}

/// The programs of the G-code tests, sample by sample.
TEST(PlannedPath, ProgramsKeepToTheirPathAndTheirLimits) {
  int programs = 0;
  for (const auto& file : std::filesystem::directory_iterator(AXIS_TEST_DATA "/gcode")) {
    if (file.path().extension() != ".ngc" || file.path().filename().string().starts_with("bad-")) continue;
    ++programs;
#ifdef AXIS_INSTRUMENTED
    if (programs % 4 != 0) continue;  // with instrumentation each takes a hundred times as long
#endif
    SCOPED_TRACE(file.path().filename());
    std::ifstream in(file.path(), std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const auto program = host::read_gcode(text, file.path().filename(), PathPoint::Zero(), {});
    const auto path = plan_path(program.moves, options());
    if (path.duration_s() > 60.0) continue;  // too long; covers nothing that shorter programs do not
    const auto points = followed(path);
    double tolerance_mm = 0.0;
    for (const PathMove& one : program.moves) tolerance_mm = std::max(tolerance_mm, one.tolerance_mm);
    const Seen seen = look_at(points, program.moves);
    EXPECT_LE(seen.velocity, 1.0 + 1e-6);
    EXPECT_LE(seen.acceleration, 1.0 + 1e-4);
    EXPECT_LE(seen.jerk, 1.0 + 2e-3) << "a rounding of 2^-16 counts is 1e-3 of it";
    EXPECT_LE(seen.off_counts, 1.0 + tolerance_mm / kCount_mm);
  }
  EXPECT_GE(programs, 38);
}

/// AXIS_PATH_PROGRAMS=10000 runs more programs (`make soak`).
TEST(PlannedPath, RandomProgramsNeverExceedTheirLimits) {
  const int programs = path_test::programs_to_try();
  double slowest = 1.0;
  Seen worst;
  for (int seed = 1; seed <= programs && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 numbers(static_cast<std::uint64_t>(seed));
    const auto moves = random_program(numbers);
    const auto path = plan_path(moves, options());
    ASSERT_TRUE(std::isfinite(path.duration_s()));
    slowest = std::max(slowest, path.stretched);
    const auto points = followed(path);
    const Seen seen = look_at(points, moves);
    EXPECT_LE(seen.velocity, 1.0 + 1e-6);
    EXPECT_LE(seen.acceleration, 1.0 + 1e-4);
    EXPECT_LE(seen.jerk, 1.0 + 5e-3);
    EXPECT_LE(seen.off_counts, 1.0 + moves.front().tolerance_mm / kCount_mm);
    EXPECT_LT((points.back() - moves.back().curve.end()).norm(), 0.5 * kCount_mm);
    worst = {std::max(worst.velocity, seen.velocity), std::max(worst.acceleration, seen.acceleration),
             std::max(worst.jerk, seen.jerk), std::max(worst.off_counts, seen.off_counts)};
  }
  RecordProperty("slowed_down_by", std::to_string(slowest));
  RecordProperty("worst_jerk", std::to_string(worst.jerk));
}

/// With slow axes, a metre takes days.
TEST(BoundedPath, IsRefusedBeforeItTakesMemory) {
  host::PathPlanOptions slow;
  slow.limits = {PathPoint::Constant(1e-6), PathPoint::Constant(1.0), PathPoint::Constant(1.0)};
  for (const host::PathCurve& curve : {host::PathCurve::line(PathPoint::Zero(), PathPoint(1000.0, 0.0, 0.0)),
                                       host::PathCurve::arc(PathPoint::Zero(), PathPoint(100.0, 0.0, 0.0), 6.0, 0.0)}) {
    host::PathMove move;
    move.curve = curve;
    move.feed_mm_s = 100.0;
    EXPECT_THROW(host::plan_path({move}, slow), host::Failure);
  }
}

}  // namespace
