// Planned paths, as the board's follower then moves the axes: within the limits, on the path, and not slower than need
// be.
#include "host/path/path_plan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <numbers>
#include <random>

#include "firmware/core/path/path_follower.hpp"
#include "host/gcode/program.hpp"
#include "host/path/path_words.hpp"

namespace {

using host::PathCurve;
using host::PathMove;
using host::PathPoint;

constexpr double kCount_mm = 0.00244140625, kRate_Hz = 1000.0;
constexpr double kVelocity = 250.0, kAcceleration = 2000.0, kJerk = 50'000.0;  // the paper's axes

host::PathPlanOptions options() {
  host::PathPlanOptions made;
  made.limits = {PathPoint::Constant(kVelocity), PathPoint::Constant(kAcceleration), PathPoint::Constant(kJerk)};
  made.count_mm = kCount_mm;
  return made;
}

PathMove move(const PathCurve& curve, double feed_mm_s, double tolerance_mm = 0.0) {
  PathMove made;
  made.curve = curve;
  made.feed_mm_s = feed_mm_s;
  made.tolerance_mm = tolerance_mm;
  return made;
}

/// The board's axes, in counts.
struct LedAxes {
  struct Axis {
    firmware::CountPosition at{};
    static firmware::SupervisorState state() { return firmware::SupervisorState::enabled; }
    void lead(firmware::Increment wanted) { at.advance(wanted); }
    double mm() const {
      return (static_cast<double>(at.counts) + std::ldexp(static_cast<double>(at.fraction), -48)) * kCount_mm;
    }
  };
  std::array<Axis, 2> axis;
  Axis& operator[](std::size_t i) { return axis[i]; }
};

/// Positions of both axes at each sample, by the board's own follower.
std::vector<PathPoint> followed(const host::PlannedPath& path) {
  const host::PathScale scale{{0, 1}, {kCount_mm, kCount_mm}, {1.0, 1.0}, kRate_Hz};
  const host::PathWords words = path_words(path, scale, units_of(path, scale), {{}, {}});
  auto follower = std::make_unique<firmware::PathFollower<2, 64>>();
  const firmware::Increment most = firmware::kMostMotion;
  follower->open(3, words.units, {}, {most, most}, firmware::kOneCount / 100, firmware::kOneCount / 1000);
  LedAxes axes;
  std::vector<PathPoint> points(3, PathPoint::Zero());
  std::size_t sent = 0;
  do {
    for (; sent < words.nodes.size() && follower->room() > 0; ++sent) {
      const auto& word = words.nodes[sent];
      EXPECT_EQ(follower->push({word.duration, {word.axis[0], word.axis[1]}}, sent + 1 == words.nodes.size(),
                               [](std::size_t, std::int64_t) { return true; }),
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

/// Shares of the limits, from differences of positions, and the way off the program in counts.
struct Seen {
  double velocity = 0.0, acceleration = 0.0, jerk = 0.0, off_counts = 0.0;
};
Seen look_at(const std::vector<PathPoint>& points, const std::vector<PathMove>& moves) {
  Seen seen;
  for (std::size_t k = 3; k < points.size(); ++k) {
    const PathPoint v = (points[k] - points[k - 1]) * kRate_Hz;
    const PathPoint a = (points[k] - 2.0 * points[k - 1] + points[k - 2]) * kRate_Hz * kRate_Hz;
    const PathPoint j =
        (points[k] - 3.0 * points[k - 1] + 3.0 * points[k - 2] - points[k - 3]) * kRate_Hz * kRate_Hz * kRate_Hz;
    seen.velocity = std::max(seen.velocity, v.cwiseAbs().maxCoeff() / kVelocity);
    seen.acceleration = std::max(seen.acceleration, a.cwiseAbs().maxCoeff() / kAcceleration);
    seen.jerk = std::max(seen.jerk, j.cwiseAbs().maxCoeff() / kJerk);
    double off_mm = std::numeric_limits<double>::infinity();
    for (const PathMove& one : moves) off_mm = std::min(off_mm, one.curve.distance_to(points[k]));
    seen.off_counts = std::max(seen.off_counts, off_mm / kCount_mm);
  }
  return seen;
}

/// Time of a straight line of so many mm: the seven phases, by hand.
double line_time(double length, double speed, double acceleration, double jerk) {
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
    EXPECT_NEAR(along.duration_s(), line_time(length, kVelocity, kAcceleration, kJerk), 3e-4 * along.duration_s());
    // Two axes share the work of a diagonal.
    const double side = length / std::numbers::sqrt2;
    const auto across = plan_path({move(PathCurve::line({0, 0, 0}, {side, side, 0}), 1e9)}, options());
    EXPECT_NEAR(across.duration_s(), line_time(side, kVelocity, kAcceleration, kJerk), 3e-4 * across.duration_s());
  }
}

/// Catches a planner that stops, or takes its acceleration back, where only the program's lines meet.
TEST(PlannedPath, ALineInPiecesIsAsQuickAsTheWhole) {
  std::vector<PathMove> pieces;
  for (int k = 0; k < 200; ++k) pieces.push_back(move(PathCurve::line({0.2 * k, 0, 0}, {0.2 * (k + 1), 0, 0}), 120.0));
  const auto path = plan_path(pieces, options());
  EXPECT_NEAR(path.duration_s(), line_time(40.0, 120.0, kAcceleration, kJerk), 1e-3);
}

/// No circle can be quicker than a line of its length with the same feed.
TEST(PlannedPath, TheCirclesTimeIsWithinThreePercentOfALineOfItsLength) {
  const auto path = plan_path({move(PathCurve::arc({0, 0, 0}, {35, 0, 0}, 2 * std::numbers::pi, 0), 170.0)}, options());
  const double least = line_time(70.0 * std::numbers::pi, 170.0, kAcceleration, kJerk);
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
  EXPECT_NEAR(square(0.0), 4.0 * line_time(40.0, 100.0, kAcceleration, kJerk), 1e-3) << "exact corners are stops";
  EXPECT_LT(square(0.01), square(0.0) - 0.04);
  EXPECT_LT(square(0.1), square(0.01) - 0.03);
}

/// The programs of the G-code tests, sample by sample.
TEST(PlannedPath, ProgramsKeepToTheirPathAndTheirLimits) {
  int programs = 0;
  for (const auto& file : std::filesystem::directory_iterator(AXIS_TEST_DATA "/gcode")) {
    if (file.path().extension() != ".ngc" || file.path().filename().string().starts_with("bad-")) continue;
    SCOPED_TRACE(file.path().filename());
    std::ifstream in(file.path(), std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const auto program = host::read_gcode(text, file.path().filename(), PathPoint::Zero(), {});
    const auto path = plan_path(program.moves, options());
    if (path.duration_s() > 60.0) continue;  // a feed for another day: nothing in it that shorter ones have not
    const auto points = followed(path);
    double tolerance_mm = 0.0;
    for (const PathMove& one : program.moves) tolerance_mm = std::max(tolerance_mm, one.tolerance_mm);
    const Seen seen = look_at(points, program.moves);
    EXPECT_LE(seen.velocity, 1.0 + 1e-6);
    EXPECT_LE(seen.acceleration, 1.0 + 1e-4);
    EXPECT_LE(seen.jerk, 1.0 + 2e-3) << "a rounding of 2^-16 counts is 1e-3 of it";
    EXPECT_LE(seen.off_counts, 1.0 + tolerance_mm / kCount_mm);
    ++programs;
  }
  EXPECT_GE(programs, 38);
}

/// Lines and arcs of all sizes, feeds and tolerances.
std::vector<PathMove> random_program(std::mt19937_64& numbers) {
  std::uniform_real_distribution<double> even(-1.0, 1.0);
  std::vector<PathMove> moves;
  PathPoint at = PathPoint::Zero();
  const double tolerance = even(numbers) > 0.0 ? 0.0 : std::pow(10.0, 1.5 * even(numbers) - 2.0);
  const int count = 2 + static_cast<int>(numbers() % 10);
  for (int k = 0; k < count; ++k) {
    const double feed = even(numbers) > 0.8 ? 1e9 : 130.0 + 125.0 * even(numbers);
    const double size = std::pow(10.0, 1.7 * even(numbers));
    const double direction = std::numbers::pi * even(numbers);
    const PathPoint there = at + size * PathPoint(std::cos(direction), std::sin(direction), 0.0);
    const bool is_arc = even(numbers) > 0.2;
    moves.push_back(move(is_arc ? PathCurve::arc(at, there, 6.0 * even(numbers), 0.0) : PathCurve::line(at, there),
                         feed, tolerance));
    at = moves.back().curve.end();
    if (!is_arc && even(numbers) > 0.3) {  // a tangent arc behind the line
      const PathPoint side(-std::sin(direction), std::cos(direction), 0.0);
      const double turn = even(numbers) * 3.0;
      moves.push_back(move(PathCurve::arc(at, at + std::copysign(size, turn) * side, turn, 0.0), feed, tolerance));
      at = moves.back().curve.end();
    }
  }
  return moves;
}

/// More of them: AXIS_PATH_PROGRAMS=10000, of `make soak`.
TEST(PlannedPath, RandomProgramsNeverExceedTheirLimits) {
  const char* wanted = std::getenv("AXIS_PATH_PROGRAMS");
  const int programs = wanted != nullptr ? std::atoi(wanted) : 40;
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

}  // namespace
