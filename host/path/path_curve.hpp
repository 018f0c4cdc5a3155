// The pieces of a path: lines, arcs (with a rise: helices) and the blends between them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace host {

/// Millimetres, x, y and z.
using PathPoint = Eigen::Vector3d;

/// Position at a length along a curve, and its derivatives by length: unit tangent and curvature vector, 1/mm.
struct CurveState {
  PathPoint point = PathPoint::Zero(), tangent = PathPoint::Zero(), curvature = PathPoint::Zero();
};

class PathCurve {
 public:
  static PathCurve line(const PathPoint& begin, const PathPoint& end);
  /// An arc about `centre` in the xy plane by `angle`, rad, positive counter-clockwise; z rises linearly to end_z.
  static PathCurve arc(const PathPoint& begin, const PathPoint& centre, double angle, double end_z);
  /// A polynomial of fifth degree from `begin` to `end` with their tangents and curvatures; its first derivative at the
  /// ends has the magnitude `reach`.
  static PathCurve blend(const CurveState& begin, const CurveState& end, double reach);

  double length() const { return length_; }
  bool is_line() const { return kind_ == Kind::line; }
  bool is_blend() const { return kind_ == Kind::blend; }
  CurveState at(double length) const;
  PathPoint begin() const { return at(0.0).point; }
  PathPoint end() const { return at(length_).point; }
  /// The smallest distance to a point, >= 0; for a blend to within its 64th part.
  double distance_to(const PathPoint& point) const;
  /// Total rotation of the tangent, rad.
  double turning() const;

  /// The part between two lengths.
  PathCurve part(double from, double to) const;

 private:
  enum class Kind { line, arc, blend };
  static constexpr std::size_t kParts = 64;  ///< intervals of a blend's table

  CurveState at_share(double share) const;
  void measure();

  Kind kind_ = Kind::line;
  double length_ = 0.0;
  PathPoint begin_ = PathPoint::Zero(), end_ = PathPoint::Zero(), centre_ = PathPoint::Zero();
  double angle_ = 0.0;
  std::array<PathPoint, 6> control_{};  ///< control points of the Bezier curve
  std::vector<double> lengths_;         ///< at the 64ths of the blend's parameter
};

}  // namespace host
