// Rounds the corners of a path, and eases its changes of curvature, within a tolerance.
#pragma once

#include <optional>

#include "host/path/path_curve.hpp"

namespace host {

/// A curve from the end of one piece into the beginning of the next, and the lengths that it replaces.
struct CornerBlend {
  PathCurve curve;
  double taken = 0.0;  ///< mm of either
};

/// No farther than `tolerance_mm` from both pieces, nor their corner from it, and no longer than `most_mm` of either.
/// Nothing where the path turns back on itself, or the corner is too sharp for the tolerance.
std::optional<CornerBlend> blend_corner(const PathCurve& before, const PathCurve& after, double tolerance_mm,
                                        double most_mm);

/// Whether tangent and curvature are continuous.
bool is_smooth(const PathCurve& before, const PathCurve& after);
/// Between the tangents, rad.
double corner_angle(const PathCurve& before, const PathCurve& after);

}  // namespace host
