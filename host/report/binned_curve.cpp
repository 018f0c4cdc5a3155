#include "host/report/binned_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace host {

namespace {

struct Bin {
  double x_sum = 0.0;
  std::vector<double> values;
};

double quantile(std::vector<double>& values, double fraction) {
  const auto rank = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

}  // namespace

BinnedCurve binned_curve(std::span<const double> x, std::span<const double> y, std::size_t bins,
                         std::size_t min_samples) {
  const std::size_t count = std::min(x.size(), y.size());
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (std::size_t k = 0; k < count; ++k) {
    if (!std::isfinite(x[k]) || !std::isfinite(y[k])) continue;
    lowest = std::min(lowest, x[k]);
    highest = std::max(highest, x[k]);
  }
  BinnedCurve curve;
  if (!(lowest <= highest) || bins == 0) return curve;

  std::vector<Bin> filled(bins);
  const double bins_per_unit = highest > lowest ? static_cast<double>(bins) / (highest - lowest) : 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    if (!std::isfinite(x[k]) || !std::isfinite(y[k])) continue;
    Bin& bin = filled[std::min(bins - 1, static_cast<std::size_t>((x[k] - lowest) * bins_per_unit))];
    bin.x_sum += x[k];
    bin.values.push_back(y[k]);
  }
  for (Bin& bin : filled) {
    if (bin.values.empty() || bin.values.size() < min_samples) continue;
    const auto samples = static_cast<double>(bin.values.size());
    curve.x.push_back(bin.x_sum / samples);
    curve.mean.push_back(std::accumulate(bin.values.begin(), bin.values.end(), 0.0) / samples);
    curve.lower.push_back(quantile(bin.values, 0.1));
    curve.upper.push_back(quantile(bin.values, 0.9));
  }
  return curve;
}

}  // namespace host
