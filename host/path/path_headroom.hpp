// Headroom of each piece of a planned path for the board's clock: how much faster it could be followed (PathClock).
#pragma once

#include "firmware/core/path/path_headroom.hpp"
#include "host/path/path_plan.hpp"

namespace host {

/// The limits that a path must keep at rate 1 in order to keep the `limits` of acceleration and jerk at `rate`.
AxisLimits limits_at_rate(const AxisLimits& limits, double rate);

void find_headroom(std::vector<PathKnot>& knots, const PathPlanOptions& options);

}  // namespace host
