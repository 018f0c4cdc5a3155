#include "host/hil/path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "firmware/core/axis_check.hpp"
#include "firmware/core/path/path_follower.hpp"
#include "host/exit_codes.hpp"
#include "host/path/path_words.hpp"
#include "host/path/speed_profile.hpp"

namespace host {

namespace {

using std::numbers::pi;

double distance(const PlanePoint& a, const PlanePoint& b) { return std::hypot(a.x - b.x, a.y - b.y); }

PathSegment line_between(const PlanePoint& begin, const PlanePoint& end) { return {begin, end, {}, 0.0}; }
PathSegment arc(const PlanePoint& begin, const PlanePoint& centre, double angle) { return {begin, {}, centre, angle}; }

}  // namespace

double PathSegment::length() const {
  return angle == 0.0 ? distance(begin, end) : std::abs(angle) * distance(begin, centre);
}

PlanePoint PathSegment::at(double along) const {
  const double whole = length();
  const double part = whole > 0.0 ? along / whole : 0.0;
  if (angle == 0.0) return {begin.x + part * (end.x - begin.x), begin.y + part * (end.y - begin.y)};
  const double c = std::cos(part * angle), s = std::sin(part * angle);
  const double x = begin.x - centre.x, y = begin.y - centre.y;
  return {centre.x + c * x - s * y, centre.y + s * x + c * y};
}

double PathSegment::distance_to(const PlanePoint& point) const {
  const double whole = length();
  if (angle == 0.0) {
    const double dx = (end.x - begin.x) / whole, dy = (end.y - begin.y) / whole;
    const double along = std::clamp((point.x - begin.x) * dx + (point.y - begin.y) * dy, 0.0, whole);
    return distance(point, at(along));
  }
  const double start = std::atan2(begin.y - centre.y, begin.x - centre.x);
  const double seen = std::atan2(point.y - centre.y, point.x - centre.x);
  double turned = std::remainder(seen - start, 2.0 * pi);
  if (turned * angle < 0.0) turned += std::copysign(2.0 * pi, angle);
  if (std::abs(turned) <= std::abs(angle)) return std::abs(distance(point, centre) - distance(begin, centre));
  return std::min(distance(point, begin), distance(point, at(whole)));
}

Path Path::line(const PlanePoint& end) {
  Path path;
  path.segments_.push_back(line_between({}, end));
  return path;
}

Path Path::circle(double radius_mm, int turns) {
  Path path;
  path.segments_.push_back(arc({0.0, 0.0}, {radius_mm, 0.0}, 2.0 * pi * turns));
  return path;
}

std::optional<PathSegment> Path::whole_circle() const {
  if (segments_.size() != 1 || std::abs(segments_.front().angle) < 2.0 * pi) return {};
  return segments_.front();
}

Path Path::rounded_square(double side_mm, double corner_radius_mm) {
  const double r = corner_radius_mm, half = side_mm / 2.0, straight = half - r;
  if (!(r > 0.0) || !(straight > 0.0)) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("a corner of {:g} mm does not fit a square of {:g} mm; it must be above 0 and below half "
                              "the side",
                              r, side_mm));
  }
  Path path;
  auto& pieces = path.segments_;
  pieces.push_back(line_between({0.0, 0.0}, {straight, 0.0}));
  pieces.push_back(arc({straight, 0.0}, {straight, r}, pi / 2));
  pieces.push_back(line_between({half, r}, {half, side_mm - r}));
  pieces.push_back(arc({half, side_mm - r}, {straight, side_mm - r}, pi / 2));
  pieces.push_back(line_between({straight, side_mm}, {-straight, side_mm}));
  pieces.push_back(arc({-straight, side_mm}, {-straight, side_mm - r}, pi / 2));
  pieces.push_back(line_between({-half, side_mm - r}, {-half, r}));
  pieces.push_back(arc({-half, r}, {-straight, r}, pi / 2));
  pieces.push_back(line_between({-straight, 0.0}, {0.0, 0.0}));
  return path;
}

double Path::length() const {
  double sum = 0.0;
  for (const PathSegment& segment : segments_) sum += segment.length();
  return sum;
}

PlanePoint Path::at(double along) const {
  for (const PathSegment& segment : segments_) {
    if (along <= segment.length() || &segment == &segments_.back()) return segment.at(along);
    along -= segment.length();
  }
  return {};
}

double Path::distance_to(const PlanePoint& point) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const PathSegment& segment : segments_) nearest = std::min(nearest, segment.distance_to(point));
  return nearest;
}

namespace {

/// Nodes in the form of the host's planner, but with limits along the path, as in the paper.
PlannedPath plan_along(const Path& path, const PathLimits& limits, double sample_period_s) {
  PlannedPath planned;
  double length = 0.0;
  std::vector<double> joints;
  for (const PathSegment& segment : path.segments()) {
    const PathPoint begin(segment.begin.x, segment.begin.y, 0.0);
    planned.curves.push_back(
        {segment.angle == 0.0 ? PathCurve::line(begin, {segment.end.x, segment.end.y, 0.0})
                              : PathCurve::arc(begin, {segment.centre.x, segment.centre.y, 0.0}, segment.angle, 0.0),
         0.0, 0});
    length += planned.curves.back().curve.length();
    joints.push_back(length);
  }
  SpeedInterval whole{0.0, length, limits.feed, [&limits](double) {
                        return TangentialLimits{limits.acceleration, limits.jerk};
                      }};
  SpeedState state;
  double time_s = 0.0;
  std::size_t curve = 0;
  const auto add = [&](const SpeedState& s, double at_s) {
    if (!planned.knots.empty() && at_s - planned.knots.back().time_s < 1.5 * sample_period_s) return;
    while (curve + 1 < joints.size() && s.length > joints[curve]) ++curve;
    const double begins = curve > 0 ? joints[curve - 1] : 0.0;
    const PathCurve& on = planned.curves[curve].curve;
    const CurveState q = on.at(std::min(s.length - begins, on.length()));
    planned.knots.push_back(
        {at_s, q.point, s.speed * q.tangent, s.speed * s.speed * q.curvature + s.acceleration * q.tangent});
  };
  add(state, 0.0);
  for (const SpeedPhase& phase : speed_profile({whole})) {
    // The acceleration jumps where a line meets an arc. Short pieces keep the polynomials close to it.
    constexpr double kPiece_s = 0.002;
    const auto parts = std::max(1, static_cast<int>(phase.duration_s / kPiece_s));
    for (int k = 1; k <= parts; ++k)
      add(after(state, phase.duration_s * k / parts, phase.jerk), time_s + phase.duration_s * k / parts);
    state = after(state, phase.duration_s, phase.jerk);
    time_s += phase.duration_s;
  }
  if (planned.knots.size() > 1) planned.knots.pop_back();
  add(state, std::max(time_s, planned.knots.back().time_s + 2.0 * sample_period_s));
  PathKnot& last = planned.knots.back();
  last.position = planned.curves.back().curve.end();
  last.velocity = last.acceleration = PathPoint::Zero();
  planned.knots.front().velocity = planned.knots.front().acceleration = PathPoint::Zero();
  return planned;
}

/// Replaces the board's axes, which the path follower moves.
struct LedAxes {
  struct Axis {
    firmware::Increment increment = 0;
    static firmware::SupervisorState state() { return firmware::SupervisorState::enabled; }
    void lead(firmware::Increment wanted) { increment = wanted; }
  };
  std::array<Axis, 2> axis;
  Axis& operator[](std::size_t i) { return axis[i]; }
};

}  // namespace

std::vector<std::array<firmware::Increment, 2>> follow_path(const Path& path, const PathLimits& limits,
                                                            double sample_period_s,
                                                            const std::array<double, 2>& count_mm) {
  using firmware::parameter_check::motion;
  constexpr double kUnit_mm = 0.001;  // unit of length along the path, instead of an encoder count
  const firmware::MotionLimits along{motion(limits.feed, kUnit_mm, sample_period_s, 1),
                                     motion(limits.acceleration, kUnit_mm, sample_period_s, 2),
                                     motion(limits.jerk, kUnit_mm, sample_period_s, 3)};
  if (check(along) != firmware::Refusal::none) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("a feed of {:g} mm/s with {:g} mm/s² and {:g} mm/s³ is outside the range of references",
                              limits.feed, limits.acceleration, limits.jerk));
  }
  constexpr double kLongest_s = 86'400.0;
  if (!(path.length() / limits.feed < kLongest_s))
    throw Failure(ExitCode::bad_input, fmt::format("a path of {:g} mm lasts too long at this feed", path.length()));
  const PlannedPath planned = plan_along(path, limits, sample_period_s);
  const PathScale scale{{0, 1}, {count_mm[0], count_mm[1]}, {1.0, 1.0}, 1.0 / sample_period_s};
  const PathWords words = path_words(planned, scale, units_of(planned, scale), {{}, {}});

  firmware::PathFollower<2, 32> follower;
  using Node = firmware::PathNode<2>;
  // The axes of this reference have no limits: they could reach the feed within one sample.
  const auto unlimited = [&](std::size_t axis) {
    const auto feed = static_cast<float>(limits.feed * sample_period_s / count_mm[axis]);
    return firmware::PathLimits{feed, feed, feed};
  };
  follower.open(3, words.units, {}, {unlimited(0), unlimited(1)});
  std::vector<std::array<firmware::Increment, 2>> increments;
  LedAxes axes;
  std::size_t sent = 0;
  do {
    for (; sent < words.nodes.size() && follower.room() > 0; ++sent) {
      const PathWord& word = words.nodes[sent];
      Node node;
      node.set_time(word.time());
      node.axis = {word.axis[0], word.axis[1]};
      const auto refusal =
          follower.push(node, sent + 1 == words.nodes.size(), [](std::size_t, std::int64_t) { return true; });
      if (refusal != firmware::Refusal::none)
        throw Failure(ExitCode::bad_input, fmt::format("a path of {:g} mm at {:g} mm/s is outside the range of an "
                                                       "encoder with steps of {:g} mm: smaller, or slower",
                                                       path.length(), limits.feed, count_mm[0]));
    }
    if (increments.empty()) follower.start();
    follower.prepare();
    follower.before_step(axes);
    increments.push_back({axes[0].increment, axes[1].increment});
  } while (follower.is_moving());
  return increments;
}

}  // namespace host
