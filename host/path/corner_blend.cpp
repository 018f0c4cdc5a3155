#include "host/path/corner_blend.hpp"

#include <algorithm>
#include <cmath>

namespace host {

namespace {

constexpr double kShortest_mm = 1e-3;  ///< no encoder distinguishes a shorter blend from a corner
constexpr double kSharpest_rad = 2.9;  ///< at larger angles the path reverses

CornerBlend blend_of(const PathCurve& before, const PathCurve& after, double taken) {
  return {PathCurve::blend(before.at(before.length() - taken), after.at(taken), 2.0 * taken), taken};
}

double deviation(const CornerBlend& blend, const PathCurve& before, const PathCurve& after) {
  double largest = blend.curve.distance_to(before.end());
  constexpr int kPoints = 16;
  for (int i = 1; i < kPoints; ++i) {
    const PathPoint point = blend.curve.at(blend.curve.length() * i / kPoints).point;
    largest = std::max(largest, std::min(before.distance_to(point), after.distance_to(point)));
  }
  return largest;
}

}  // namespace

double corner_angle(const PathCurve& before, const PathCurve& after) {
  const PathPoint a = before.at(before.length()).tangent, b = after.at(0.0).tangent;
  return 2.0 * std::atan2((b - a).norm(), (b + a).norm());
}

bool is_smooth(const PathCurve& before, const PathCurve& after) {
  const CurveState a = before.at(before.length()), b = after.at(0.0);
  return (b.tangent - a.tangent).norm() < 1e-7 && (b.curvature - a.curvature).norm() < 1e-7;
}

std::optional<CornerBlend> blend_corner(const PathCurve& before, const PathCurve& after, double tolerance_mm,
                                        double most_mm) {
  if (corner_angle(before, after) > kSharpest_rad || most_mm < kShortest_mm) return {};
  CornerBlend best = blend_of(before, after, most_mm);
  if (deviation(best, before, after) <= tolerance_mm) return best;
  double fits = 0.0, too_far = most_mm;
  for (int k = 0; k < 40 && too_far - fits > 0.01 * fits; ++k) {
    const double middle = fits > 0.0 ? (fits + too_far) / 2.0 : too_far / 4.0;
    const CornerBlend tried = blend_of(before, after, middle);
    if (deviation(tried, before, after) <= tolerance_mm) {
      fits = middle;
      best = tried;
    } else {
      too_far = middle;
    }
    if (too_far < kShortest_mm) return {};
  }
  return best;
}

}  // namespace host
