// The bounding box of a planned path, and a check that it fits the machine.
#pragma once

#include <string>

#include "host/path/path_plan.hpp"

namespace host {

struct PathExtents {
  PathPoint least, most;  ///< mm
};

/// Extents of the whole path, to within 0.001 mm; no coordinate is -0.
PathExtents extents_of(const PlannedPath& path);

/// Throws Failure(refused) "NAME:LINE: …" for the first point of the path beyond a limit of one of its axes.
void require_inside(const PlannedPath& path, const PathExtents& limits, std::size_t axes, const std::string& name);

}  // namespace host
