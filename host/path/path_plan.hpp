// A program's motion, planned: from moves and their feeds to nodes that a board follows.
#pragma once

#include <string>
#include <vector>

#include "host/path/path_curve.hpp"

namespace host {

/// Of each axis, mm and s.
struct AxisLimits {
  PathPoint velocity, acceleration, jerk;
};

enum class PathMoveKind { motion, probe /* from rest to rest */, dwell, stop /* until the operator lets it go on */ };

struct PathMove {
  PathMoveKind kind = PathMoveKind::motion;
  PathCurve curve;
  double feed_mm_s = 0.0;  ///< along the path
  double dwell_s = 0.0;
  double tolerance_mm = 0.0;  ///< of the corner at its end; 0: the path is exact there
  std::size_t line = 0;       ///< of the program
};

/// Of all axes at one time.
struct PathKnot {
  double time_s = 0.0;
  PathPoint position, velocity, acceleration;
  /// The rates at which the limits of acceleration and jerk would be held: by the piece that ends here and what it
  /// touches; by all that comes until a board's clock, which might change there, could be brought to what the least of
  /// them allows.
  double headroom_here = 1.0, headroom_ahead = 1.0;
};

/// A curve as it is followed.
struct PlannedCurve {
  PathCurve curve;
  double time_s = 0.0;   ///< at its begin
  std::size_t line = 0;  ///< of the program
};

/// Where a program waits for its operator.
struct PathStop {
  std::size_t knot = 0;  ///< at rest
  std::size_t line = 0;  ///< of the program
};

struct PlannedPath {
  std::vector<PathKnot> knots;  ///< from the first, at rest, to the last, at rest
  std::vector<PlannedCurve> curves;
  std::vector<PathStop> stops;
  double stretched = 1.0;  ///< the largest factor by which a part was slowed down to hold the limits
  double duration_s() const { return knots.empty() ? 0.0 : knots.back().time_s; }
};

struct PathPlanOptions {
  AxisLimits limits;
  double count_mm = 0.001;              ///< the finest encoder step: half of it is the tolerance of an exact path
  double shortest_s = 0.002;            ///< between knots
  double time_unit_s = 0.001 / 4096.0;  ///< in which a board has the time between them
};

/// Within the limits of each axis, as quickly as the planner can; those of acceleration and jerk so that they would be
/// held at the rate firmware::kLeastHeadroom too, which a clock needs that must change. Corners are stopped at where
/// their tolerance is 0 and they are no smooth going on. Throws Failure(bad_input) where a limit or a feed is not above
/// 0.
PlannedPath plan_path(const std::vector<PathMove>& moves, const PathPlanOptions& options);

/// Of what the knots' polynomials ask of the axes, the largest share of a limit: 1 at the limit.
struct LimitUse {
  double velocity = 0.0, acceleration = 0.0, jerk = 0.0;
};
LimitUse limit_use(const PathKnot* begin, const PathKnot* end, const AxisLimits& limits);

/// Between two knots, as the board has it.
PathKnot between(const PathKnot& a, const PathKnot& b, double time_s);

}  // namespace host
