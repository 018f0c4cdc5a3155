#include "host/path/path_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/exit_codes.hpp"
#include "host/input_limits.hpp"
#include "host/path/corner_blend.hpp"
#include "host/path/path_bounds.hpp"
#include "host/path/path_headroom.hpp"
#include "host/path/path_span.hpp"

namespace host {

namespace {

constexpr double kGoesOn_rad = 0.05;  ///< smaller corners are rounded within half a count, without a stop
constexpr double kSharp_rad =
    0.6;  ///< at larger angles, stopping on one leg while starting on the other is quicker than a curve
constexpr double kMargin = 1.0 + 1e-4;  ///< margin for the motion between the checked points
constexpr int kCheckedPoints = 16;      ///< points of a polynomial that are checked

/// Spans that overlap in time if a tolerance allows it: one starts while the previous one stops, each within its own
/// limits.
class Chain {
 public:
  explicit Chain(const PathPlanOptions& options) : options_(options) {}

  bool is_empty() const { return spans_.empty(); }

  /// `tolerance_mm`: tolerance of the corner between the previous span and this one.
  void add(PathSpan span, double tolerance_mm) {
    constexpr int kRounds = 4;
    for (int k = 0; k < kRounds && span.tighten(knots_of({span}, {0.0})); ++k) continue;
    span.stretch(excess({span}, {0.0}));
    double begin_s = 0.0;
    if (!spans_.empty()) {
      begin_s = begins_.back() + spans_.back().duration_s();
      double early_s = overlap(spans_.back(), span, tolerance_mm);
      // Checked with the motion of the knots: a slightly later begin here is better than slowing down the whole path.
      constexpr int kTrials = 8;
      for (int k = 0; k < kTrials && early_s > 0.0; ++k, early_s *= 0.96)
        if (excess({spans_.back(), span}, {0.0, spans_.back().duration_s() - early_s}) < 1.0005) break;
      begin_s -= early_s;
    }
    spans_.push_back(std::move(span));
    begins_.push_back(begin_s);
  }

  void add_to(PlannedPath& path) {
    if (spans_.empty()) return;
    // Slowing down changes the knots and the motion between them slightly, so this is repeated once or twice.
    constexpr int kRounds = 4;
    for (int k = 0; k < kRounds; ++k) {
      const double more = excess(spans_, begins_);
      if (more == 1.0) break;
      for (PathSpan& span : spans_) span.stretch(more);
      for (double& begin_s : begins_) begin_s *= more;
    }
    for (const PathSpan& span : spans_) path.stretched = std::max(path.stretched, span.stretched());
    const double from_s = path.knots.back().time_s;
    const std::vector<PathKnot> knots = knots_of(spans_, begins_);
    require_bounded(path.knots.size() + knots.size(), from_s + knots.back().time_s,
                    spans_.front().curves().front().line);
    for (std::size_t k = 1; k < knots.size(); ++k) {
      path.knots.push_back(knots[k]);
      path.knots.back().time_s += from_s;
    }
    for (std::size_t i = 0; i < spans_.size(); ++i)
      for (const SpanCurve& one : spans_[i].curves())
        path.curves.push_back({one.curve, from_s + begins_[i] + spans_[i].begins_s(one), one.line});
    spans_.clear();
    begins_.clear();
  }

 private:
  /// Sum of all spans at one time, each relative to its own beginning.
  static PathKnot at(const std::vector<PathSpan>& spans, const std::vector<double>& begins, double time_s) {
    const auto next = std::ranges::upper_bound(begins, time_s);
    const auto k = static_cast<std::size_t>(std::max<std::ptrdiff_t>(next - begins.begin() - 1, 0));
    PathKnot knot = spans[k].at(time_s - begins[k]);
    knot.time_s = time_s;
    if (k == 0 || time_s >= begins[k - 1] + spans[k - 1].duration_s()) return knot;
    const PathKnot before = spans[k - 1].at(time_s - begins[k - 1]);  // the overlaps at two corners do not meet
    knot.position += before.position - spans[k - 1].last().end();
    knot.velocity += before.velocity;
    knot.acceleration += before.acceleration;
    return knot;
  }

  std::vector<PathKnot> knots_of(const std::vector<PathSpan>& spans, const std::vector<double>& begins) const {
    std::vector<PathSpan::Wanted> wanted;
    for (std::size_t i = 0; i < spans.size(); ++i)
      for (const PathSpan::Wanted& one : spans[i].knot_times()) wanted.push_back({begins[i] + one.time_s, one.weight});
    std::ranges::sort(wanted, {}, &PathSpan::Wanted::time_s);
    std::vector<PathSpan::Wanted> kept{{0.0, 3}};
    for (const PathSpan::Wanted& one : wanted) {
      if (one.time_s - kept.back().time_s >= options_.shortest_s * 0.999)
        kept.push_back(one);
      else if (one.weight > kept.back().weight &&
               (kept.size() < 2 || one.time_s - kept[kept.size() - 2].time_s >= options_.shortest_s))
        kept.back() = one;
    }
    const double end_s = begins.back() + spans.back().duration_s();
    while (kept.size() > 1 && end_s - kept.back().time_s < options_.shortest_s) kept.pop_back();
    std::vector<PathKnot> knots;
    const double unit_s = options_.time_unit_s;
    for (const PathSpan::Wanted& one : kept)
      knots.push_back(at(spans, begins, std::round(one.time_s / unit_s) * unit_s));
    knots.push_back(spans.back().at(end_s));
    knots.back().time_s =
        std::ceil(std::max(end_s, knots[knots.size() - 2].time_s + options_.shortest_s) / unit_s) * unit_s;
    return knots;
  }

  /// Factor by which they must be slowed down to keep the limits; 1 if they keep them.
  double excess(const std::vector<PathSpan>& spans, const std::vector<double>& begins) const {
    const std::vector<PathKnot> knots = knots_of(spans, begins);
    const LimitUse use = limit_use(knots.data(), knots.data() + knots.size(), options_.limits);
    const double factor = std::max({1.0, use.velocity, std::sqrt(use.acceleration), std::cbrt(use.jerk)});
    return factor > 1.0 ? factor * kMargin : 1.0;
  }

  /// The longest time by which the next span may begin early: within the tolerance of the corner, and the limits.
  double overlap(const PathSpan& before, const PathSpan& next, double tolerance_mm) const {
    if (!(tolerance_mm > 0.0)) return 0.0;
    double most = std::min({before.duration_s() / 2.0, next.duration_s() / 2.0,
                            before.duration_s() - before.last_begins_s(), next.first_ends_s()});
    double fits = 0.0;
    for (int k = 0; k < 24 && most - fits > 1e-4; ++k) {
      const double tried = k == 0 ? most : (fits + most) / 2.0;
      (may_overlap(before, next, tried, tolerance_mm) ? fits : most) = tried;
      if (k == 0 && fits > 0.0) return fits;
    }
    return fits;
  }

  bool may_overlap(const PathSpan& before, const PathSpan& next, double time_s, double tolerance_mm) const {
    constexpr int kPoints = 24;
    constexpr double kRounding = 1.0 + 1e-9;
    const PathPoint corner = before.last().end();
    const double from_s = before.duration_s() - time_s;
    double nearest = std::numeric_limits<double>::infinity();
    PathPoint last = PathPoint::Zero();
    for (int i = 0; i <= kPoints; ++i) {
      const double at_s = time_s * i / kPoints;
      const PathKnot a = before.at(from_s + at_s), b = next.at(at_s);
      const PathPoint point = a.position + b.position - corner;
      nearest = std::min(nearest, (point - corner).norm());
      if (std::min(before.last().distance_to(point), next.first().distance_to(point)) > tolerance_mm) return false;
      const PathPoint acceleration = a.acceleration + b.acceleration;
      const auto is_within = [&](const PathPoint& value, const PathPoint& limit) {
        return (value.cwiseAbs().array() <= kRounding * limit.array()).all();
      };
      if (!is_within(a.velocity + b.velocity, options_.limits.velocity)) return false;
      if (!is_within(acceleration, options_.limits.acceleration)) return false;
      if (i > 0 && !is_within((acceleration - last) * (kPoints / time_s), options_.limits.jerk)) return false;
      last = acceleration;
    }
    return nearest <= tolerance_mm;
  }

  const PathPlanOptions& options_;
  std::vector<PathSpan> spans_;
  std::vector<double> begins_;
};

/// Joins moves to spans: with blends if there is a tolerance, otherwise with stops.
class Joiner {
 public:
  Joiner(PlannedPath& path, const PathPlanOptions& options) : path_(path), options_(options) {}

  void add(const PathMove& move) {
    const bool is_probe = move.kind == PathMoveKind::probe;
    if (move.kind != PathMoveKind::motion) stop();
    if (move.kind != PathMoveKind::motion && !is_probe) {
      dwell(move);
      if (move.kind == PathMoveKind::stop) path_.stops.push_back({path_.knots.size() - 1, move.line});
      return;
    }
    if (path_.knots.empty()) path_.knots.push_back({0.0, move.curve.begin(), PathPoint::Zero(), PathPoint::Zero()});
    if (!(move.curve.length() > 0.0)) return;
    if (!span_.empty()) join(move);
    tolerance_mm_ = move.tolerance_mm;
    span_.push_back({move.curve, move.feed_mm_s, move.line, 0.0});
    whole_mm_ = move.curve.length();
    begin_mm_ = taken_mm_;
    taken_mm_ = 0.0;
    if (is_probe) stop();
  }

  /// Ends the span: the axes stand afterwards.
  void stop() {
    end_span();
    chain_.add_to(path_);
  }

 private:
  void end_span() {
    if (span_.empty()) return;
    cut_last(0.0);
    chain_.add(PathSpan(std::move(span_), options_), entry_mm_);
    entry_mm_ = tolerance_mm_;
    span_.clear();
  }

  void join(const PathMove& next) {
    const PathCurve& before = span_.back().curve;
    if (is_smooth(before, next.curve)) return cut_last(0.0);
    const bool is_slight = corner_angle(before, next.curve) <= kGoesOn_rad;
    if (tolerance_mm_ <= 0.0 && !is_slight) return stop();
    if (corner_angle(before, next.curve) > kSharp_rad) return end_span();
    const auto blend = blend_corner(before, next.curve, std::max(tolerance_mm_, options_.count_mm / 2.0),
                                    std::min(whole_mm_, next.curve.length()) / 2.0);
    if (!blend || !is_worthwhile(*blend)) return end_span();
    const SpanCurve last = span_.back();
    cut_last(blend->taken);
    span_.push_back({blend->curve, std::min(last.feed_mm_s, next.feed_mm_s), next.line, 0.0});
    taken_mm_ = blend->taken;
  }

  /// Whether the blend is faster than a stop, which needs at least this time for the replaced length.
  bool is_worthwhile(const CornerBlend& blend) const {
    const SpeedInterval passed =
        interval_of({blend.curve, std::numeric_limits<double>::infinity(), 0, 0.0}, options_.limits);
    return blend.curve.length() / passed.speed < 2.0 * std::cbrt(6.0 * blend.taken / options_.limits.jerk.minCoeff());
  }

  /// Lengths of the newest curve that blends replace at its beginning and at its end.
  void cut_last(double end_mm) {
    const double to = whole_mm_ - end_mm;
    if (to - begin_mm_ <= whole_mm_ * 1e-9)
      span_.pop_back();
    else if (begin_mm_ > 0.0 || end_mm > 0.0)
      span_.back().curve = span_.back().curve.part(begin_mm_, to);
    begin_mm_ = 0.0;
  }

  void dwell(const PathMove& move) {
    if (path_.knots.empty()) path_.knots.push_back({0.0, move.curve.begin(), PathPoint::Zero(), PathPoint::Zero()});
    constexpr double kLongestPiece_s = 0.05;  // always within the range of a node
    // A stop needs a separate node, at which a board without further nodes stands.
    const int least = move.kind == PathMoveKind::stop ? 1 : 0;
    const auto parts = std::max(least, static_cast<int>(std::ceil(move.dwell_s / kLongestPiece_s)));
    for (int k = 0; k < parts; ++k) {
      PathKnot knot = path_.knots.back();
      const double wanted_s = std::max(move.dwell_s / parts, options_.shortest_s);
      knot.time_s += std::ceil(wanted_s / options_.time_unit_s) * options_.time_unit_s;
      path_.knots.push_back(knot);
    }
  }

  PlannedPath& path_;
  const PathPlanOptions& options_;
  Chain chain_{options_};
  std::vector<SpanCurve> span_;
  double entry_mm_ = 0.0;      ///< tolerance of the corner at the beginning of the span
  double tolerance_mm_ = 0.0;  ///< tolerance of the next corner
  double whole_mm_ = 0.0;      ///< length of the newest curve before it was cut
  double begin_mm_ = 0.0;      ///< length at its beginning replaced by the blend
  double taken_mm_ = 0.0;      ///< length at the beginning of the next curve replaced by the newest blend
};

}  // namespace

PathKnot between(const PathKnot& a, const PathKnot& b, double time_s) {
  const double T = b.time_s - a.time_s, u = (time_s - a.time_s) / T;
  const PathPoint way = b.position - a.position, v0 = T * a.velocity, v1 = T * b.velocity;
  const PathPoint a0 = T * T * a.acceleration, a1 = T * T * b.acceleration;
  const PathPoint c2 = a0 / 2.0, c3 = 10.0 * way - 6.0 * v0 - 4.0 * v1 - (3.0 * a0 - a1) / 2.0;
  const PathPoint c4 = -15.0 * way + 8.0 * v0 + 7.0 * v1 + (3.0 * a0 - 2.0 * a1) / 2.0;
  const PathPoint c5 = 6.0 * way - 3.0 * (v0 + v1) - (a0 - a1) / 2.0;
  return {time_s, a.position + u * (v0 + u * (c2 + u * (c3 + u * (c4 + u * c5)))),
          (v0 + u * (2.0 * c2 + u * (3.0 * c3 + u * (4.0 * c4 + u * 5.0 * c5)))) / T,
          (2.0 * c2 + u * (6.0 * c3 + u * (12.0 * c4 + u * 20.0 * c5))) / (T * T)};
}

LimitUse limit_use(const PathKnot* begin, const PathKnot* end, const AxisLimits& limits) {
  LimitUse use;
  const auto share = [](const PathPoint& value, const PathPoint& limit) {
    return value.cwiseAbs().cwiseQuotient(limit).maxCoeff();
  };
  for (const PathKnot* knot = begin; knot + 1 < end; ++knot) {
    const double time = knot[1].time_s - knot->time_s;
    PathPoint last = knot->acceleration;
    for (int i = 1; i <= kCheckedPoints; ++i) {
      const PathKnot here = between(knot[0], knot[1], knot->time_s + time * i / kCheckedPoints);
      use.velocity = std::max(use.velocity, share(here.velocity, limits.velocity));
      use.acceleration = std::max(use.acceleration, share(here.acceleration, limits.acceleration));
      use.jerk = std::max(use.jerk, share((here.acceleration - last) * (kCheckedPoints / time), limits.jerk));
      last = here.acceleration;
    }
  }
  return use;
}

PlannedPath plan_path(const std::vector<PathMove>& moves, const PathPlanOptions& options) {
  for (const PathPoint& limit : {options.limits.velocity, options.limits.acceleration, options.limits.jerk})
    if (!(limit.minCoeff() > 0.0))
      throw Failure(ExitCode::bad_input, "a path needs velocity, acceleration and jerk limits above 0 of every axis");
  PathPlanOptions reserved = options;
  reserved.limits = limits_at_rate(options.limits, firmware::kLeastHeadroom);
  PlannedPath path;
  Joiner joiner(path, reserved);
  for (const PathMove& move : moves) {
    if (move.kind == PathMoveKind::motion && !(move.feed_mm_s > 0.0))
      throw Failure(ExitCode::bad_input, fmt::format("line {}: a feed above 0 is needed", move.line));
    joiner.add(move);
  }
  joiner.stop();
  find_headroom(path.knots, options);
  return path;
}

std::size_t line_at(const PlannedPath& path, double time_s) {
  const auto next = std::ranges::upper_bound(path.curves, time_s, {}, &PlannedCurve::time_s);
  return next == path.curves.begin() ? 0 : (next - 1)->line;
}

}  // namespace host
