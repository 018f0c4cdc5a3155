// The largest contour error of a run, um.
#pragma once

#include <algorithm>

#include "host/hil/scenario_run.hpp"

inline double largest_contour_error_um(const host::ScenarioRun& run) {
  return *std::ranges::max_element(run.contour_um);
}
