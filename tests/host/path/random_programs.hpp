// Random programs for the paper's axes, ideal axes that follow them, and measurements of their motion.
#pragma once

#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "firmware/core/path/path_follower.hpp"
#include "host/path/path_words.hpp"
#include "tests/host/skip_where_instrumented.hpp"

namespace path_test {

using host::PathCurve;
using host::PathMove;
using host::PathPoint;

/// AXIS_PATH_PROGRAMS, or 40; a tenth of them with instrumentation, which makes each a hundred times slower.
inline int programs_to_try() {
  if (const char* wanted = std::getenv("AXIS_PATH_PROGRAMS")) return std::atoi(wanted);
#ifdef AXIS_INSTRUMENTED
  return 4;
#else
  return 40;
#endif
}

inline constexpr double kCount_mm = 0.00244140625, kRate_Hz = 1000.0;
inline constexpr double kVelocity = 250.0, kAcceleration = 2000.0, kJerk = 50'000.0;  // the paper's axes

/// Limits of each axis in the board's form.
inline firmware::PathLimits board_limits() {
  const auto per_sample = [](double of_mm, int power) {
    return static_cast<float>(of_mm / kCount_mm / std::pow(kRate_Hz, power));
  };
  return {per_sample(kVelocity, 1), per_sample(kAcceleration, 2), per_sample(kJerk, 3)};
}

inline host::PathPlanOptions options() {
  host::PathPlanOptions made;
  made.limits = {PathPoint::Constant(kVelocity), PathPoint::Constant(kAcceleration), PathPoint::Constant(kJerk)};
  made.count_mm = kCount_mm;
  return made;
}

inline PathMove move(const PathCurve& curve, double feed_mm_s, double tolerance_mm = 0.0) {
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

inline firmware::PathNode<2> node_of(const host::PathWord& word) {
  firmware::PathNode<2> node;
  node.set_time(word.time());
  node.axis = {word.axis[0], word.axis[1]};
  return node;
}

/// Used shares of the limits, from differences of positions, and the distance from the programmed path in counts.
struct Seen {
  double velocity = 0.0, acceleration = 0.0, jerk = 0.0, off_counts = 0.0;
};
inline Seen look_at(const std::vector<PathPoint>& points, const std::vector<PathMove>& moves) {
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

/// Lines and arcs of all sizes, feeds and tolerances.
inline std::vector<PathMove> random_program(std::mt19937_64& numbers) {
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
    if (!is_arc && even(numbers) > 0.3) {  // a tangent arc after the line
      const PathPoint side(-std::sin(direction), std::cos(direction), 0.0);
      const double turn = even(numbers) * 3.0;
      moves.push_back(move(PathCurve::arc(at, at + std::copysign(size, turn) * side, turn, 0.0), feed, tolerance));
      at = moves.back().curve.end();
    }
  }
  return moves;
}

}  // namespace path_test
