// How much faster each piece of a planned path could be followed, for the board's clock: PathClock.
#pragma once

#include "firmware/core/path/path_headroom.hpp"
#include "host/path/path_plan.hpp"

namespace host {

/// Those that a path must hold at rate 1 so that it holds `limits` of acceleration and jerk at `rate`.
AxisLimits limits_at_rate(const AxisLimits& limits, double rate);

void find_headroom(std::vector<PathKnot>& knots, const PathPlanOptions& options);

}  // namespace host
