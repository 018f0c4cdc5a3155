// Headroom of each piece of a planned path: how much faster the board's clock could follow it (PathClock).
#pragma once

#include "firmware/core/path/path_headroom.hpp"
#include "host/path/path_plan.hpp"

namespace host {

/// Limits at rate 1 with which a path keeps the `limits` of acceleration and jerk at `rate`.
AxisLimits limits_at_rate(const AxisLimits& limits, double rate);

void find_headroom(std::vector<PathKnot>& knots, const PathPlanOptions& options);

}  // namespace host
