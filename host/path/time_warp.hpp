// Makes a motion along a path faster, within the same limits, by changing its time scale.
#pragma once

#include <functional>
#include <vector>

#include "host/path/path_plan.hpp"

namespace host {

/// Demand on the axes at one time of a motion, and the highest rate there.
struct WarpDemand {
  PathPoint velocity, acceleration, jerk;
  double fastest = 0.0;  ///< the rate at which the feed is reached
  double share = 1.0;    ///< allowed share of the limits of acceleration and jerk
};

/// Time t for each time tau of a motion, with the rate r = dtau / dt, r^2 piecewise quadratic over tau and smooth: the
/// accelerations r^2 q'' + (r^2)' q' / 2 and, but for a factor r, the jerks are linear in it (Verscheure et al.,
/// Time-optimal path tracking for robots, 2009; the jerk after Debrouwere et al., 2013).
class TimeWarp {
 public:
  /// No warp: t = tau.
  TimeWarp() = default;
  /// The fastest warp over cells between these times, to within 0.2 %, by an interior-point method that starts at a
  /// constant rate. The motion begins at rest at time 0 and ends at rest. `demand`: demand of the motion between two
  /// times.
  TimeWarp(std::vector<double> cells, const std::function<WarpDemand(double, double)>& demand,
           const AxisLimits& limits);

  bool is_none() const { return square_.empty(); }
  struct State {
    double time_s = 0.0;                   ///< tau
    double rate = 1.0, rate_change = 0.0;  ///< dtau / dt, and its derivative by t, 1/s
  };
  State at(double warped_s) const;
  /// The time t for a time tau.
  double warped(double time_s) const;
  /// Times t of the cell boundaries at which the change of the rate jumps noticeably.
  const std::vector<double>& bends() const { return bends_; }

 private:
  struct Square {
    double value, slope;
  };
  Square square_at(std::size_t cell, double share) const;
  double passed(std::size_t cell, double share) const;

  std::vector<double> cells_;
  std::vector<double> square_;  ///< coefficients of r^2 in B-splines of second degree
  std::vector<double> times_;   ///< times t of the cell boundaries
  std::vector<double> bends_;
};

}  // namespace host
