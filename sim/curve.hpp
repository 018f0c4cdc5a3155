// A curve through knots.
#pragma once

#include <string_view>
#include <vector>

#include "sim/drive_description.hpp"

namespace sim {

/// Possible coordinates of a free curve.
inline constexpr std::string_view kCurveCoordinates[] = {
    "speed",   "position", "friction_along_position", "travel_since_reversal", "time", "friction_over_time",
    "current", "phase"};

/// Linear between knots, constant beyond the first and the last. Over "phase" it is periodic instead: first and last
/// knot have equal values, and their distance is the period.
class Curve {
 public:
  /// Takes the entry's `knot` and `value` parameters: equally many of both, with knots in ascending order.
  explicit Curve(const EffectEntry& entry);

  double operator()(double q) const;
  double slope(double q) const;

  const std::vector<double>& knots() const { return knots_; }
  const std::vector<double>& values() const { return values_; }
  /// Period along the travel, mm or m; 0 if the curve is not periodic.
  double period() const { return period_; }

 private:
  double folded(double q) const;

  std::vector<double> knots_, values_;
  double period_ = 0.0;
};

}  // namespace sim
