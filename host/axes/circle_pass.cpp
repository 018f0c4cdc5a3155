#include "host/axes/circle_pass.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/dense_solutions.hpp"
#include "host/exit_codes.hpp"
#include "host/statistics.hpp"

namespace host {

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kLeastTurn = 0.8 * kTurn;  ///< shortest pass: one turn minus acceleration and deceleration
constexpr double kMostTurns = 3.0;          ///< longest pass; more turns add no information
constexpr std::size_t kMostPasses = 12;
constexpr double kSteady = 0.02;    ///< relative change of the feed within a pass
constexpr double kOnCircle = 0.02;  ///< largest distance from the circle relative to the radius
constexpr double kSpeedWindow_s = 0.03;

template <typename... Args>
[[noreturn]] void fail(const Record& record, fmt::format_string<Args...> format, Args&&... args) {
  throw Failure(ExitCode::bad_input, record.path + ": " + fmt::format(format, std::forward<Args>(args)...));
}

const std::vector<double>* column(const Record& record, const std::string& name) {
  for (const ExtraChannel& one : record.extra)
    if (one.name == name) return &one.values;
  return nullptr;
}

std::vector<double> scaled(const std::vector<double>& values, double factor) {
  std::vector<double> list = values;
  for (double& value : list) value *= factor;
  return list;
}

/// Both axes of one machine, mm; empty where a channel was not recorded.
struct PlaneRecord {
  std::string name;
  double period_s = 0.0;
  std::vector<double> t_s, x, y, x_ref, y_ref, x2, y2, ballbar;
};

void require_finite(const Record& record, const std::vector<double>& values, const std::string& what) {
  for (std::size_t k = 0; k < values.size(); ++k)
    if (!std::isfinite(values[k]))
      fail(record, "row {} of {} is not a number; correct it, or cut the record before this row", k + 1, what);
}

void take_ballbar(const Record& record, PlaneRecord& plane) {
  for (const auto& [name, factor] : {std::pair("radius_mm", 1.0), std::pair("radius_um", 1e-3)})
    if (const auto* values = column(record, name)) {
      require_finite(record, *values, name);
      plane.ballbar = scaled(*values, factor);
    }
}

PlaneRecord one_record(const Record& record) {
  PlaneRecord plane{record.path, record.sample_period_s, record.t_s, {}, {}, {}, {}, {}, {}, {}};
  const double mm = record.kind == sim::DriveKind::linear ? 1e3 : 1.0;
  plane.x = scaled(record.x, mm);
  plane.x_ref = scaled(record.x_ref, mm);
  plane.x2 = scaled(record.x2, mm);
  const auto take = [&](const std::string& name, std::vector<double>& into) {
    for (const auto& [unit, factor] : {std::pair("_mm", 1.0), std::pair("_m", 1e3)})
      if (const auto* values = column(record, name + unit)) {
        require_finite(record, *values, name + unit);
        into = scaled(*values, factor);
      }
  };
  take("y", plane.y);
  take("y_ref", plane.y_ref);
  take("y2", plane.y2);
  take_ballbar(record, plane);
  return plane;
}

PlaneRecord two_records(const Record& x, const Record& y) {
  if (x.size() != y.size() || std::abs(x.sample_period_s - y.sample_period_s) > 1e-9)
    fail(y, "has {} rows every {:g} s, {} has {} every {:g} s: give both axes of one run", y.size(), y.sample_period_s,
         x.path, x.size(), x.sample_period_s);
  if (std::abs(x.t_s.front() - y.t_s.front()) > 0.5 * x.sample_period_s)
    fail(y, "begins at {:g} s, {} at {:g} s: give both axes of one run", y.t_s.front(), x.path, x.t_s.front());
  PlaneRecord plane = one_record(x), other = one_record(y);
  plane.name += ", " + y.path;
  plane.y = other.x;
  plane.y_ref = other.x_ref;
  plane.y2 = other.x2;
  if (plane.ballbar.empty()) plane.ballbar = other.ballbar;
  return plane;
}

std::vector<PlaneRecord> planes_of(const std::vector<Record>& records) {
  std::vector<PlaneRecord> planes;
  std::vector<const Record*> x, y;
  for (const Record& record : records) {
    if (!record.has_position()) fail(record, "has no position: a circle needs x_mm and y_mm");
    if (column(record, "y_mm") != nullptr)
      planes.push_back(one_record(record));
    else if (record.drive == "x" || record.drive == "y")
      (record.drive == "x" ? x : y).push_back(&record);
    else
      fail(record,
           "has no y_mm, and \"# drive: {}\" does not say whether it is axis x or y: give one record with x_mm "
           "and y_mm, or one of each axis with `# drive: x` and `# drive: y`",
           record.drive);
  }
  if (x.size() != y.size())
    throw Failure(ExitCode::bad_input,
                  fmt::format("{} records of axis x and {} of axis y: give both of every run", x.size(), y.size()));
  for (std::size_t i = 0; i < x.size(); ++i) planes.push_back(two_records(*x[i], *y[i]));
  return planes;
}

struct Circle {
  double x = 0.0, y = 0.0, radius = 0.0;
  double off(double px, double py) const { return std::hypot(px - x, py - y) - radius; }
};

/// Least squares (Kasa) of the points in `keep`.
Circle fit_circle(const std::vector<double>& x, const std::vector<double>& y, const std::vector<std::size_t>& keep) {
  const double x0 = x[keep.front()], y0 = y[keep.front()];
  Eigen::Matrix3d gram = Eigen::Matrix3d::Zero();
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(3);
  for (const std::size_t k : keep) {
    const double dx = x[k] - x0, dy = y[k] - y0;
    const Eigen::Vector3d row(dx, dy, 1.0);
    gram += row * row.transpose();
    pull += row * (dx * dx + dy * dy);
  }
  const Eigen::VectorXd found = symmetric_solution(gram, pull);
  const double cx = found(0) / 2.0, cy = found(1) / 2.0;
  return {x0 + cx, y0 + cy, std::sqrt(std::max(0.0, found(2) + cx * cx + cy * cy))};
}

/// Fits a circle repeatedly, each time without the points of the motion before and after it.
Circle find_circle(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<std::size_t> keep(x.size());
  for (std::size_t k = 0; k < keep.size(); ++k) keep[k] = k;
  Circle circle;
  for (int round = 0; round < 12 && keep.size() > 3; ++round) {
    circle = fit_circle(x, y, keep);
    const double reach = std::max(kOnCircle, 0.3 * std::pow(0.6, round)) * circle.radius;
    keep.clear();
    for (std::size_t k = 0; k < x.size(); ++k)
      if (std::abs(circle.off(x[k], y[k])) < reach) keep.push_back(k);
  }
  return circle;
}

std::vector<double> unwrapped_angle(const Circle& circle, const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<double> angle(x.size());
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double at = std::atan2(y[k] - circle.y, x[k] - circle.x);
    angle[k] = k == 0 ? at : angle[k - 1] + std::remainder(at - angle[k - 1], kTurn);
  }
  return angle;
}

struct SteadyStretch {
  std::size_t first, end;
};

/// Ranges in which the point moves on the circle at a steady speed, long enough.
std::vector<SteadyStretch> steady_stretches(const PlaneRecord& plane, const Circle& circle,
                                            const std::vector<double>& angle) {
  const auto half = static_cast<std::size_t>(std::max(2.0, 0.5 * kSpeedWindow_s / plane.period_s));
  std::vector<SteadyStretch> found;
  if (angle.size() < 4 * half) return found;
  const auto speed = [&](std::size_t k) {
    return (angle[k + half] - angle[k - half]) / (2.0 * static_cast<double>(half) * plane.period_s);
  };
  std::size_t k = half;
  const std::size_t last = angle.size() - half;
  while (k < last) {
    // A speed is steady if it is the same a little later.
    const double now = speed(k);
    const std::size_t later = k + 2 * half;
    const auto holds = [&](std::size_t at) {
      return std::abs(speed(at) - now) < kSteady * std::abs(now) &&
             std::abs(circle.off(plane.x[at], plane.y[at])) < kOnCircle * circle.radius;
    };
    if (now == 0.0 || later >= last || !holds(k) || !holds(later)) {
      ++k;
      continue;
    }
    std::size_t end = k;
    while (end < last && holds(end)) ++end;
    std::size_t used = k;
    while (used < end && std::abs(angle[used] - angle[k]) <= kMostTurns * kTurn) ++used;
    if (std::abs(angle[used - 1] - angle[k]) >= kLeastTurn) found.push_back({k, used});
    k = end;
  }
  return found;
}

double smallest_count(const std::vector<double>& values) {
  double least = HUGE_VAL;
  for (std::size_t k = 1; k < values.size(); ++k)
    if (const double step = std::abs(values[k] - values[k - 1]); step > 1e-9) least = std::min(least, step);
  return std::isfinite(least) ? least : 0.0;
}

CirclePass pass_of(const PlaneRecord& plane, const Circle& circle, const std::vector<double>& angle,
                   const SteadyStretch& stretch) {
  CirclePass pass;
  const double turned = angle[stretch.end - 1] - angle[stretch.first];
  const double duration_s = static_cast<double>(stretch.end - 1 - stretch.first) * plane.period_s;
  pass.source = plane.name;
  pass.is_ccw = turned > 0.0;
  pass.radius_mm = circle.radius;
  pass.feed_mm_s = std::abs(turned) / duration_s * circle.radius;
  pass.period_s = plane.period_s;
  pass.has_reference = !plane.x_ref.empty() && !plane.y_ref.empty();
  pass.count_um = 1e3 * std::max(smallest_count(plane.x), smallest_count(plane.y));
  pass.outer = !plane.ballbar.empty()                   ? OuterSensor::ballbar
               : !plane.x2.empty() && !plane.y2.empty() ? OuterSensor::scales
                                                        : OuterSensor::none;
  // A ballbar gives its length or its deviation.
  const double bar =
      plane.ballbar.empty() || std::abs(median(plane.ballbar)) < 0.5 * circle.radius ? 0.0 : circle.radius;
  double late = 0.0;
  for (std::size_t k = stretch.first; k < stretch.end; ++k) {
    const double x = plane.x[k] - circle.x, y = plane.y[k] - circle.y, at = std::atan2(y, x);
    pass.t_s.push_back(plane.t_s[k]);
    pass.angle_rad.push_back(at);
    pass.encoder_um.push_back(1e3 * (std::hypot(x, y) - circle.radius));
    if (pass.outer == OuterSensor::ballbar) pass.outer_um.push_back(1e3 * (plane.ballbar[k] - bar));
    if (pass.outer == OuterSensor::scales) pass.outer_um.push_back(1e3 * circle.off(plane.x2[k], plane.y2[k]));
    if (pass.has_reference)
      late += pass.direction() *
              (std::cos(at) * (plane.y_ref[k] - plane.y[k]) - std::sin(at) * (plane.x_ref[k] - plane.x[k]));
  }
  pass.lag_s = late / static_cast<double>(pass.t_s.size()) / pass.feed_mm_s;
  pass.rests = {rests_of(pass, 'x'), rests_of(pass, 'y')};
  return pass;
}

}  // namespace

std::vector<CirclePass> circle_passes(const std::vector<Record>& records) {
  std::vector<CirclePass> passes;
  for (const PlaneRecord& plane : planes_of(records)) {
    const bool has_reference = !plane.x_ref.empty() && !plane.y_ref.empty();
    const std::vector<double>&x = has_reference ? plane.x_ref : plane.x, &y = has_reference ? plane.y_ref : plane.y;
    const Circle circle = find_circle(x, y);
    if (!(circle.radius > 0.0) || !std::isfinite(circle.radius)) continue;
    const std::vector<double> angle = unwrapped_angle(circle, x, y);
    for (const SteadyStretch& stretch : steady_stretches(plane, circle, angle))
      passes.push_back(pass_of(plane, circle, angle, stretch));
  }
  if (passes.empty())
    throw Failure(ExitCode::refused,
                  "no turn of a circle at a steady feed in these records: command full circles (G2, G3), preferably "
                  "two turns, because a single one accelerates and decelerates");
  if (passes.size() > kMostPasses)
    throw Failure(ExitCode::usage,
                  fmt::format("{} stretches of circles: give at most {} at once; both directions at two "
                              "feeds are enough",
                              passes.size(), kMostPasses));
  return passes;
}

}  // namespace host
