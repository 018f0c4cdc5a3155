// Rounds the corners of a path, and smooths its changes of curvature, within a tolerance.
#pragma once

#include <optional>

#include "host/path/path_curve.hpp"

namespace host {

/// A curve from the end of one piece to the beginning of the next, and the lengths that it replaces.
struct CornerBlend {
  PathCurve curve;
  double taken = 0.0;  ///< mm of each piece
};

/// The blend and the pieces with their corner are at most `tolerance_mm` apart, and it replaces at most `most_mm` of
/// each piece. Empty if the path reverses, or the corner is too sharp for the tolerance.
std::optional<CornerBlend> blend_corner(const PathCurve& before, const PathCurve& after, double tolerance_mm,
                                        double most_mm);

/// Whether tangent and curvature are continuous.
bool is_smooth(const PathCurve& before, const PathCurve& after);
/// Angle between the tangents, rad.
double corner_angle(const PathCurve& before, const PathCurve& after);

}  // namespace host
