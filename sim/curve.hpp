// A curve through knots.
#pragma once

#include <string_view>
#include <vector>

#include "sim/drive_description.hpp"

namespace sim {

/// Coordinates that a free curve may go over.
inline constexpr std::string_view kCurveCoordinates[] = {
    "speed",   "position", "friction_along_position", "travel_since_reversal", "time", "friction_over_time",
    "current", "phase"};

/// Straight between knots, level beyond the first and the last; over "phase" it comes back instead, and the distance
/// from the first knot to the last, whose values are the same, is its period.
class Curve {
 public:
  /// From the entry's `knot` and `value`, which are as many; knots rise with their number.
  explicit Curve(const EffectEntry& entry);

  double operator()(double q) const;
  double slope(double q) const;

  const std::vector<double>& knots() const { return knots_; }
  const std::vector<double>& values() const { return values_; }
  /// Travel until it comes back, mm or m; 0 where it does not.
  double period() const { return period_; }

 private:
  double folded(double q) const;

  std::vector<double> knots_, values_;
  double period_ = 0.0;
};

}  // namespace sim
