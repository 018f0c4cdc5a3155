#include "host/path/path_span.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/input_limits.hpp"
#include "host/path/path_bounds.hpp"

namespace host {

namespace {

constexpr double kLongest_s = 0.02;    ///< between knots: a board's look-ahead is a fixed number of knots
constexpr double kLargestTurn = 0.15;  ///< rad between knots: the polynomial is then within 1e-9 of the radius
constexpr double kCellOfRamp = 0.125;  ///< cell of the warp, relative to the time for an axis to reach its acceleration

/// Motion of the axes per unit of motion along a curve: magnitudes of the first, second and third derivative by length.
struct CurveDemand {
  PathPoint first, second, third;
};

std::vector<CurveDemand> demands_of(const PathCurve& curve) {
  const int points = curve.is_line()    ? 1
                     : curve.is_blend() ? 48
                                        : std::clamp(static_cast<int>(curve.turning() * 12.0), 5, 80);
  std::vector<CurveDemand> demands;
  const double length = curve.length(), step = length * 1e-3;
  for (int i = 0; i < points; ++i) {
    const double here = points == 1 ? length / 2.0 : length * i / (points - 1);
    const CurveState state = curve.at(here);
    const double a = std::max(here - step, 0.0), b = std::min(here + step, length);
    const PathPoint third = (curve.at(b).curvature - curve.at(a).curvature) / (b - a);
    demands.push_back({state.tangent.cwiseAbs(), state.curvature.cwiseAbs(), third.cwiseAbs()});
  }
  return demands;
}

double least_share(const PathPoint& limit, const PathPoint& demand) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i)
    if (demand[i] > 1e-15) least = std::min(least, limit[i] / demand[i]);
  return least;
}

}  // namespace

SpeedInterval interval_of(const SpanCurve& span, const AxisLimits& limits) {
  SpeedInterval interval;
  interval.begin = span.begin;
  interval.end = span.begin + span.curve.length();
  interval.speed = span.feed_mm_s;
  const std::vector<CurveDemand> demands = demands_of(span.curve);
  for (const CurveDemand& d : demands) {
    interval.speed =
        std::min({interval.speed, least_share(limits.velocity, d.first),
                  std::sqrt(least_share(limits.acceleration, d.second)), std::cbrt(least_share(limits.jerk, d.third))});
  }
  interval.limits = [demands, limits](double speed) {
    TangentialLimits found;
    found.acceleration = std::numeric_limits<double>::infinity();
    for (const CurveDemand& d : demands)
      found.acceleration =
          std::min(found.acceleration, least_share(limits.acceleration - speed * speed * d.second, d.first));
    // On a curve, tangential acceleration causes jerk across it, so less acceleration leaves more jerk.
    const double most = found.acceleration;
    for (const double share : {1.0, 0.75, 0.5, 0.35, 0.2, 0.1}) {
      found.acceleration = most * share;
      found.jerk = std::numeric_limits<double>::infinity();
      double alone = std::numeric_limits<double>::infinity();
      for (const CurveDemand& d : demands) {
        const PathPoint left = limits.jerk - speed * (3.0 * found.acceleration * d.second + speed * speed * d.third);
        found.jerk = std::min(found.jerk, least_share(left, d.first));
        alone = std::min(alone, least_share(limits.jerk, d.first));
      }
      if (found.jerk > 0.3 * alone) break;
    }
    return found;
  };
  return interval;
}

PathSpan::PathSpan(std::vector<SpanCurve> curves, const PathPlanOptions& options)
    : curves_(std::move(curves)), options_(options) {
  double length = 0.0;
  std::vector<SpeedInterval> intervals;
  for (SpanCurve& one : curves_) {
    one.begin = length;
    length += one.curve.length();
    intervals.push_back(interval_of(one, options_.limits));
  }
  phases_ = speed_profile(intervals);
  states_.push_back({});
  times_.push_back(0.0);
  for (const SpeedPhase& phase : phases_) {
    states_.push_back(after(states_.back(), phase.duration_s, phase.jerk));
    times_.push_back(times_.back() + phase.duration_s);
  }
  require_bounded(0, times_.back(), curves_.front().line);
  // The profile has one acceleration and jerk per phase. If curves need a part of the limits, it does not use the rest.
  const bool is_straight = std::ranges::all_of(curves_, [](const SpanCurve& one) { return one.curve.is_line(); });
  if (is_straight) return;
  cells_ = warp_cells();
  shares_.assign(cells_.size(), 1.0);
  warp();
}

bool PathSpan::tighten(const std::vector<PathKnot>& knots) {
  if (warp_.is_none()) return false;
  bool is_changed = false;
  for (std::size_t k = 1; k < knots.size(); ++k) {
    const LimitUse use = limit_use(&knots[k - 1], &knots[k] + 1, options_.limits);
    const double most = std::max(use.acceleration, use.jerk);
    if (most <= 1.0) continue;
    is_changed = true;
    const std::size_t last = cell_at(warp_.at(knots[k].time_s - 1e-9).time_s);
    for (std::size_t cell = cell_at(warp_.at(knots[k - 1].time_s + 1e-9).time_s); cell <= last; ++cell)
      shares_[cell] /= most * 1.002;
  }
  if (is_changed) warp();
  return is_changed;
}

PathKnot PathSpan::at(double time_s) const {
  if (time_s <= 0.0) return {time_s, first().begin(), PathPoint::Zero(), PathPoint::Zero()};
  if (time_s >= duration_s()) return {time_s, last().end(), PathPoint::Zero(), PathPoint::Zero()};
  const TimeWarp::State warped = warp_.at(time_s / factor_);
  PathKnot knot = knot_at(warped.time_s);
  knot.time_s = time_s;
  knot.acceleration =
      (warped.rate * warped.rate * knot.acceleration + warped.rate_change * knot.velocity) / (factor_ * factor_);
  knot.velocity *= warped.rate / factor_;
  return knot;
}

std::vector<PathSpan::Wanted> PathSpan::knot_times() const {
  std::vector<Wanted> wanted;
  for (const double time_s : times_) wanted.push_back({time_s, 2});
  for (std::size_t i = 1; i < curves_.size(); ++i) wanted.push_back({time_at(curves_[i].begin), 1});
  for (Wanted& one : wanted) one.time_s = warp_.warped(one.time_s);
  for (const double time_s : warp_.bends()) wanted.push_back({time_s, 1});
  std::ranges::sort(wanted, {}, &Wanted::time_s);
  const std::size_t events = wanted.size();
  for (std::size_t i = 0; i + 1 < events; ++i) {
    const double from = wanted[i].time_s, time = wanted[i + 1].time_s - from;
    const SpeedState middle = state_at(warp_.at(from + time / 2.0).time_s);
    const SpanCurve& span = curve_at(middle.length);
    const double turning = span.curve.at(middle.length - span.begin).curvature.norm() * middle.speed * time;
    double parts = std::max(time / kLongest_s, turning / kLargestTurn);
    if (span.curve.is_blend()) parts = std::max(parts, 8.0 * middle.speed * time / span.curve.length());
    const auto count = static_cast<int>(std::ceil(std::min({parts, time / options_.shortest_s, 2.0 * kMostPathNodes})));
    require_bounded(wanted.size() + static_cast<std::size_t>(count), duration_s(), span.line);
    for (int k = 1; k < count; ++k) wanted.push_back({from + time * k / count, 0});
  }
  for (Wanted& one : wanted) one.time_s *= factor_;
  return wanted;
}

SpeedState PathSpan::state_at(double time_s) const {
  const auto next = std::upper_bound(times_.begin() + 1, times_.end() - 1, time_s);
  const auto k = static_cast<std::size_t>(next - times_.begin()) - 1;
  return after(states_[k], time_s - times_[k], phases_[k].jerk);
}

double PathSpan::time_at(double length) const {
  double low = 0.0, high = times_.back();
  for (int k = 0; k < 60; ++k) {
    const double middle = (low + high) / 2.0;
    (state_at(middle).length < length ? low : high) = middle;
  }
  return high;
}

/// Cells whose boundaries include the jumps of the jerk, and which are short enough for the warp.
std::vector<double> PathSpan::warp_cells() const {
  std::vector<double> events = times_;
  for (std::size_t i = 1; i < curves_.size(); ++i) events.push_back(time_at(curves_[i].begin));
  std::ranges::sort(events);
  double cell_s = kLongest_s;
  for (int i = 0; i < 3; ++i)
    cell_s = std::min(cell_s, kCellOfRamp * options_.limits.acceleration[i] / options_.limits.jerk[i]);
  cell_s = std::max(cell_s, 2.0 * options_.shortest_s);
  std::vector<double> cells{0.0};
  for (const double event : events) {
    const double from = cells.back(), time = event - from;
    if (time < 1.5 * options_.shortest_s) continue;
    const auto parts = static_cast<int>(std::ceil(time / cell_s));
    require_bounded(cells.size() + static_cast<std::size_t>(parts), times_.back(), curves_.front().line);
    for (int k = 1; k <= parts; ++k) cells.push_back(from + time * k / parts);
  }
  cells.back() = times_.back();
  return cells;
}

WarpDemand PathSpan::demand(double from_s, double to_s) const {
  const PathKnot knot = knot_at((from_s + to_s) / 2.0), before = knot_at(from_s + 1e-9), after = knot_at(to_s - 1e-9);
  const SpanCurve& span = curve_at(state_at(knot.time_s).length);
  return {knot.velocity, knot.acceleration, (after.acceleration - before.acceleration) / (to_s - from_s),
          span.feed_mm_s / std::max(knot.velocity.norm(), 1e-9), shares_[cell_at(knot.time_s)]};
}

void PathSpan::warp() {
  if (cells_.size() < 5) return;
  warp_ = TimeWarp(
      cells_, [this](double from_s, double to_s) { return demand(from_s, to_s); }, options_.limits);
}

std::size_t PathSpan::cell_at(double time_s) const {
  const auto next = std::upper_bound(cells_.begin() + 1, cells_.end() - 1, time_s);
  return static_cast<std::size_t>(next - cells_.begin()) - 1;
}

const SpanCurve& PathSpan::curve_at(double length) const {
  const auto next = std::partition_point(curves_.begin() + 1, curves_.end(),
                                         [&](const SpanCurve& one) { return one.begin <= length; });
  return *(next - 1);
}

PathKnot PathSpan::knot_at(double time_s) const {
  const SpeedState s = state_at(time_s);
  const SpanCurve& span = curve_at(s.length);
  const CurveState q = span.curve.at(std::min(s.length - span.begin, span.curve.length()));
  return {time_s, q.point, s.speed * q.tangent, s.speed * s.speed * q.curvature + s.acceleration * q.tangent};
}

}  // namespace host
