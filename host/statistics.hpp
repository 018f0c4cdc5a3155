// Basic statistics for several folders.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace host {

/// Half width of a normal distribution's 95 % interval, in standard deviations.
inline constexpr double kNormal95 = 1.96;

/// Both functions return 0 if there are no values.
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

/// Whether all finite values are the same.
inline bool is_constant(const std::vector<double>& values) {
  const auto first = std::ranges::find_if(values, [](double value) { return std::isfinite(value); });
  return first == values.end() ||
         std::ranges::all_of(values, [&](double value) { return !std::isfinite(value) || value == *first; });
}

/// Quantile: the value that the fraction `part` (0 to 1) of the values does not exceed. Needs at least one value.
inline double quantile(std::vector<double> values, double part) {
  const auto rank = values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, rank);
  return *rank;
}

/// Median; for an even number of values, the larger of the two in the middle. Needs at least one value.
inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace host
