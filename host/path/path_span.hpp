// A part of a path from rest to rest, along curves, with its timing.
#pragma once

#include <vector>

#include "host/path/path_plan.hpp"
#include "host/path/speed_profile.hpp"
#include "host/path/time_warp.hpp"

namespace host {

struct SpanCurve {
  PathCurve curve;
  double feed_mm_s = 0.0;
  std::size_t line = 0;
  double begin = 0.0;  ///< length along the span at its beginning
};

/// Limits of the motion along a curve.
SpeedInterval interval_of(const SpanCurve& span, const AxisLimits& limits);

/// First computes the profile, which has one acceleration and jerk per phase. If curves need a part of the limits, the
/// profile leaves some of the rest unused; a time warp then uses it.
class PathSpan {
 public:
  PathSpan(std::vector<SpanCurve> curves, const PathPlanOptions& options);

  double duration_s() const { return warp_.warped(times_.back()) * factor_; }
  const std::vector<SpanCurve>& curves() const { return curves_; }
  const PathCurve& first() const { return curves_.front().curve; }
  const PathCurve& last() const { return curves_.back().curve; }
  double first_ends_s() const { return curves_.size() > 1 ? begins_s(curves_[1]) : duration_s(); }
  double last_begins_s() const { return begins_s(curves_.back()); }
  double begins_s(const SpanCurve& one) const { return factor_ * warp_.warped(time_at(one.begin)); }

  /// If the polynomials between the knots exceed a limit, reduces the warp's share of it there and computes the warp
  /// again. False if no limit is exceeded, or if there is no warp.
  bool tighten(const std::vector<PathKnot>& knots);

  /// Slows the whole span down by a factor.
  void stretch(double factor) { factor_ *= factor; }
  double stretched() const { return factor_; }

  /// State at a time; at rest before the beginning and after the end.
  PathKnot at(double time_s) const;

  struct Wanted {
    double time_s;
    int weight;
  };
  /// Times of knots: where the jerk changes, where curves meet, and in between as often as the curve requires; without
  /// the ends.
  std::vector<Wanted> knot_times() const;

 private:
  SpeedState state_at(double time_s) const;
  double time_at(double length) const;
  std::vector<double> warp_cells() const;
  WarpDemand demand(double from_s, double to_s) const;
  void warp();
  std::size_t cell_at(double time_s) const;
  const SpanCurve& curve_at(double length) const;
  PathKnot knot_at(double time_s) const;

  std::vector<SpanCurve> curves_;
  const PathPlanOptions& options_;
  std::vector<SpeedPhase> phases_;
  std::vector<SpeedState> states_;
  std::vector<double> times_;
  std::vector<double> cells_, shares_;  ///< of the warp, and its allowed shares of the limits
  TimeWarp warp_;
  double factor_ = 1.0;
};

}  // namespace host
