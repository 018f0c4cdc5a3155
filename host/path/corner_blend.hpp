// Rounds corners and smooths changes of curvature of a path within a tolerance.
#pragma once

#include <optional>

#include "host/path/path_curve.hpp"

namespace host {

/// A curve that replaces the end of one piece and the beginning of the next.
struct CornerBlend {
  PathCurve curve;
  double taken = 0.0;  ///< length replaced of each piece, mm
};

/// The blend deviates from the corner by at most `tolerance_mm` and replaces at most `most_mm` of each piece. Empty if
/// the path reverses, or the corner is too sharp for the tolerance.
std::optional<CornerBlend> blend_corner(const PathCurve& before, const PathCurve& after, double tolerance_mm,
                                        double most_mm);

/// Whether tangent and curvature are continuous.
bool is_smooth(const PathCurve& before, const PathCurve& after);
/// Angle between the tangents, rad.
double corner_angle(const PathCurve& before, const PathCurve& after);

}  // namespace host
