#include "host/hil/path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "firmware/core/axis_check.hpp"
#include "firmware/core/move_profile.hpp"
#include "host/exit_codes.hpp"

namespace host {

namespace {

constexpr double kPi = std::numbers::pi;

double distance(const PlanePoint& a, const PlanePoint& b) { return std::hypot(a.x - b.x, a.y - b.y); }

PathSegment line(const PlanePoint& begin, const PlanePoint& end) { return {begin, end, {}, 0.0}; }
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
  double turned = std::remainder(seen - start, 2.0 * kPi);
  if (turned * angle < 0.0) turned += std::copysign(2.0 * kPi, angle);
  if (std::abs(turned) <= std::abs(angle)) return std::abs(distance(point, centre) - distance(begin, centre));
  return std::min(distance(point, begin), distance(point, at(whole)));
}

Path Path::circle(double radius_mm, int turns) {
  Path path;
  path.segments_.push_back(arc({0.0, 0.0}, {radius_mm, 0.0}, 2.0 * kPi * turns));
  return path;
}

std::optional<PathSegment> Path::whole_circle() const {
  if (segments_.size() != 1 || std::abs(segments_.front().angle) < 2.0 * kPi) return {};
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
  pieces.push_back(line({0.0, 0.0}, {straight, 0.0}));
  pieces.push_back(arc({straight, 0.0}, {straight, r}, kPi / 2));
  pieces.push_back(line({half, r}, {half, side_mm - r}));
  pieces.push_back(arc({half, side_mm - r}, {straight, side_mm - r}, kPi / 2));
  pieces.push_back(line({straight, side_mm}, {-straight, side_mm}));
  pieces.push_back(arc({-straight, side_mm}, {-straight, side_mm - r}, kPi / 2));
  pieces.push_back(line({-half, side_mm - r}, {-half, r}));
  pieces.push_back(arc({-half, r}, {-straight, r}, kPi / 2));
  pieces.push_back(line({-straight, 0.0}, {0.0, 0.0}));
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

std::vector<std::array<firmware::Increment, 2>> follow_path(const Path& path, const PathLimits& limits,
                                                            double sample_period_s,
                                                            const std::array<double, 2>& count_mm) {
  using firmware::parameter_check::motion;
  constexpr double kUnit_mm = 0.001;  // of the way along the path, in place of an encoder's count
  const firmware::MotionLimits along{motion(limits.feed, kUnit_mm, sample_period_s, 1),
                                     motion(limits.acceleration, kUnit_mm, sample_period_s, 2),
                                     motion(limits.jerk, kUnit_mm, sample_period_s, 3)};
  if (check(along) != firmware::MotionLimitError::none) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("a feed of {:g} mm/s with {:g} mm/s² and {:g} mm/s³ is outside the range of references",
                              limits.feed, limits.acceleration, limits.jerk));
  }
  constexpr double kOne = static_cast<double>(firmware::kOneCount);
  const double units = path.length() / kUnit_mm;
  const auto whole = static_cast<std::int64_t>(units);
  const auto planned = firmware::plan_move({whole, std::llround((units - static_cast<double>(whole)) * kOne)}, along);
  if (planned.error != firmware::MovePlanError::none)
    throw Failure(ExitCode::bad_input, fmt::format("a path of {:g} mm lasts too long at this feed", path.length()));
  firmware::MoveProfile profile;
  profile.start(planned.plan);
  std::vector<std::array<firmware::Increment, 2>> increments;
  firmware::CountPosition travelled;
  std::array<double, 2> given{};  // on the grid below
  while (!profile.is_done()) {
    travelled.advance(profile.next());
    const double distance_mm =
        kUnit_mm * (static_cast<double>(travelled.counts) + static_cast<double>(travelled.fraction) / kOne);
    const PlanePoint point = path.at(distance_mm);
    const std::array<double, 2> position_mm{point.x, point.y};
    std::array<firmware::Increment, 2> step{};
    for (std::size_t i = 0; i < 2; ++i) {
      // Below 2^-20 counts the axis does not tell a difference; on that grid doubles are exact up to 2^33 counts. As
      // increments whole positions would not fit: only their differences are made ones.
      constexpr double kGrid = 1 << 20, kFarthest = 0x1p53, kLargestStep = 16384 * kGrid;  // as motion limits have it
      const double target = std::round(position_mm[i] / count_mm[i] * kGrid);
      const double change = target - given[i];
      if (!(std::abs(target) <= kFarthest) || !(std::abs(change) <= kLargestStep))
        throw Failure(
            ExitCode::bad_input,
            fmt::format("a path of {:g} mm at {:g} mm/s is outside the range of an encoder with steps of {:g} "
                        "mm: smaller, or slower",
                        path.length(), limits.feed, count_mm[i]));
      step[i] = static_cast<firmware::Increment>(change) * (firmware::kOneCount >> 20);
      given[i] = target;
    }
    increments.push_back(step);
  }
  return increments;
}

}  // namespace host
