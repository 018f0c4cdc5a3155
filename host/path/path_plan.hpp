// Plans a program's motion: from moves and their feeds to nodes that a board follows.
#pragma once

#include <string>
#include <vector>

#include "host/path/path_curve.hpp"

namespace host {

/// Limits of each axis, in mm and s.
struct AxisLimits {
  PathPoint velocity, acceleration, jerk;
};

enum class PathMoveKind { motion, probe /* from rest to rest */, dwell, stop /* until the operator lets it go on */ };

struct PathMove {
  PathMoveKind kind = PathMoveKind::motion;
  PathCurve curve;
  double feed_mm_s = 0.0;  ///< feed along the path
  double dwell_s = 0.0;
  double tolerance_mm = 0.0;  ///< tolerance of the corner at its end; 0: the path is exact there
  std::size_t line = 0;       ///< of the program
};

/// State of all axes at one time.
struct PathKnot {
  double time_s = 0.0;
  PathPoint position, velocity, acceleration;
  /// Clock rates up to which the limits of acceleration and jerk are kept. `headroom_here`: for the piece that ends
  /// here and its neighbours. `headroom_ahead`: for all pieces until the board's clock could have slowed down to their
  /// smallest rate.
  double headroom_here = 1.0, headroom_ahead = 1.0;
};

/// A curve with its time.
struct PlannedCurve {
  PathCurve curve;
  double time_s = 0.0;   ///< time of its beginning
  std::size_t line = 0;  ///< of the program
};

/// A stop at which the program waits for the operator.
struct PathStop {
  std::size_t knot = 0;  ///< index of the knot at rest
  std::size_t line = 0;  ///< of the program
};

struct PlannedPath {
  std::vector<PathKnot> knots;  ///< the first and the last are at rest
  std::vector<PlannedCurve> curves;
  std::vector<PathStop> stops;
  double stretched = 1.0;  ///< the largest factor by which a part was slowed down to keep the limits
  double duration_s() const { return knots.empty() ? 0.0 : knots.back().time_s; }
};

/// Line of the program at this time of the path; 0 before the first.
std::size_t line_at(const PlannedPath& path, double time_s);

struct PathPlanOptions {
  AxisLimits limits;
  double count_mm = 0.001;              ///< the finest encoder step: half of it is the tolerance of an exact path
  double shortest_s = 0.002;            ///< shortest time between knots
  double time_unit_s = 0.001 / 4096.0;  ///< unit of the time between knots on a board
};

/// Plans the motion as fast as possible within the limits of each axis. The limits of acceleration and jerk are also
/// kept at the clock rate firmware::kLeastHeadroom, because a changing clock needs this reserve. The path stops at
/// corners with a tolerance of 0 unless they are smooth. Throws Failure(bad_input) if a limit or a feed is not above 0.
PlannedPath plan_path(const std::vector<PathMove>& moves, const PathPlanOptions& options);

/// The largest use of each limit by the polynomials between knots; 1: at the limit.
struct LimitUse {
  double velocity = 0.0, acceleration = 0.0, jerk = 0.0;
};
LimitUse limit_use(const PathKnot* begin, const PathKnot* end, const AxisLimits& limits);

/// Motion between two knots, as on the board.
PathKnot between(const PathKnot& a, const PathKnot& b, double time_s);

}  // namespace host
