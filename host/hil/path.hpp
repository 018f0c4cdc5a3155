// Plane paths of lines and arcs, and the references that move two axes along them.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "firmware/core/arithmetic/count_position.hpp"

namespace host {

/// Millimetres, x and y.
struct PlanePoint {
  double x = 0.0;
  double y = 0.0;
};

/// A straight line (angle 0), or an arc about `centre` that turns by `angle` (rad, positive counter-clockwise).
struct PathSegment {
  PlanePoint begin;
  PlanePoint end;  ///< end point of a line
  PlanePoint centre;
  double angle = 0.0;

  double length() const;
  PlanePoint at(double distance) const;
  /// Smallest distance of a point to this piece, >= 0.
  double distance_to(const PlanePoint& point) const;
};

class Path {
 public:
  /// From the origin to `end`, which must differ from it.
  static Path line(const PlanePoint& end);
  /// Starts and ends at the origin; the centre lies at (radius, 0). `turns` full turns, counter-clockwise; negative
  /// ones clockwise.
  static Path circle(double radius_mm, int turns = 1);
  /// Starts and ends at the origin, the middle of the lower side; corners are quarter circles.
  /// Throws Failure(bad_input) if the corners do not fit the side.
  static Path rounded_square(double side_mm, double corner_radius_mm);

  double length() const;
  PlanePoint at(double distance) const;
  double distance_to(const PlanePoint& point) const;
  const std::vector<PathSegment>& segments() const { return segments_; }
  /// The path as a circle; empty for other paths.
  std::optional<PathSegment> whole_circle() const;

 private:
  std::vector<PathSegment> segments_;
};

/// Limits along the path, mm/s, mm/s^2, mm/s^3.
struct PathLimits {
  double feed = 170.0;           // the paper, p. 1508
  double acceleration = 2000.0;  // likewise
  double jerk = 50'000.0;        // likewise
};

/// Increments of both axes, sample by sample, from rest to rest. The board's path follower computes them from nodes
/// that are jerk-limited along the path. The end position is exact. Throws Failure(bad_input) for limits outside the
/// references' range.
std::vector<std::array<firmware::Increment, 2>> follow_path(const Path& path, const PathLimits& limits,
                                                            double sample_period_s,
                                                            const std::array<double, 2>& count_mm);

}  // namespace host
