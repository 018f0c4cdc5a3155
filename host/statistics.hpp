// Small statistics that several folders need.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace host {

/// Half of a normal distribution's 95 % interval, in standard deviations.
inline constexpr double kNormal95 = 1.96;

/// 0 of no values, as the next one.
inline double largest_magnitude(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

inline double root_mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values.size()));
}

}  // namespace host
