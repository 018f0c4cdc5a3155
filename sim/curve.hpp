// A curve through knots.
#pragma once

#include <string_view>
#include <vector>

#include "sim/drive_description.hpp"

namespace sim {

/// Coordinates that a free curve may go over.
inline constexpr std::string_view kCurveCoordinates[] = {
    "speed", "position", "friction_along_position", "travel_since_reversal", "time", "current"};

/// Straight between knots, level beyond the first and the last.
class Curve {
 public:
  /// From the entry's `knot` and `value`, which are as many; knots rise with their number.
  explicit Curve(const EffectEntry& entry);

  double operator()(double q) const;
  double slope(double q) const;

  const std::vector<double>& knots() const { return knots_; }
  const std::vector<double>& values() const { return values_; }

 private:
  std::vector<double> knots_, values_;
};

}  // namespace sim
