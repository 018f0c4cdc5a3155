#include "host/report/binned_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "host/statistics.hpp"

namespace host {

namespace {

using Sample = std::pair<double, double>;  // coordinate, value

void append_bin(BinnedCurve& curve, std::span<const Sample> bin) {
  const auto samples = static_cast<double>(bin.size());
  double x_sum = 0.0, y_sum = 0.0;
  std::vector<double> values;
  for (const auto& [x, y] : bin) {
    x_sum += x;
    y_sum += y;
    values.push_back(y);
  }
  curve.x.push_back(x_sum / samples);
  curve.mean.push_back(y_sum / samples);
  curve.lower.push_back(quantile(values, 0.1));
  curve.upper.push_back(quantile(values, 0.9));
  curve.samples.push_back(samples);
}

void append_gap(BinnedCurve& curve, double x) {
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  curve.x.push_back(x);
  for (auto* values : {&curve.mean, &curve.lower, &curve.upper}) values->push_back(kNothing);
  curve.samples.push_back(0.0);
}

/// The edges of the bins are whole multiples of the width.
void append_stretch(BinnedCurve& curve, std::span<const Sample> stretch, double width, std::size_t min_samples) {
  const auto cell = [&](std::size_t k) { return std::floor(stretch[k].first / width); };
  while (!stretch.empty()) {
    std::size_t end = 1;
    while (end < stretch.size() && (end < min_samples || cell(end) == cell(end - 1))) ++end;
    if (stretch.size() - end < min_samples) end = stretch.size();
    append_bin(curve, stretch.first(end));
    stretch = stretch.subspan(end);
  }
}

}  // namespace

double bin_width(double wanted, double period) {
  constexpr double kBinsAPeriod = 8.0;
  constexpr double kMostFiner = 3.0;  // at most so many times the wanted bins to show a ripple
  if (!(period > 0.0)) return wanted;
  if (kBinsAPeriod * wanted > kMostFiner * period) return period * std::ceil(wanted / period);
  return period / std::max(kBinsAPeriod, std::round(period / wanted));
}

BinnedCurve binned_curve(std::span<const double> x, std::span<const double> y, std::size_t bins,
                         std::size_t min_samples, double period) {
  constexpr double kGap = 5.0;  // bin widths
  std::vector<Sample> samples;
  for (std::size_t k = 0; k < std::min(x.size(), y.size()); ++k)
    if (std::isfinite(x[k]) && std::isfinite(y[k])) samples.emplace_back(x[k], y[k]);
  BinnedCurve curve;
  if (samples.empty() || bins == 0) return curve;
  std::ranges::stable_sort(samples, {}, &Sample::first);
  const double width = bin_width((samples.back().first - samples.front().first) / static_cast<double>(bins), period);
  double last_x = samples.front().first;
  for (std::span<const Sample> rest = samples; !rest.empty();) {
    std::size_t end = 1;
    while (end < rest.size() && rest[end].first - rest[end - 1].first <= kGap * width) ++end;
    if (end >= min_samples) {
      if (!curve.x.empty()) append_gap(curve, (last_x + rest.front().first) / 2.0);
      append_stretch(curve, rest.first(end), width, std::max<std::size_t>(min_samples, 1));
      last_x = rest[end - 1].first;
    }
    rest = rest.subspan(end);
  }
  return curve;
}

ScatterSeries curve_series(const std::string& name, SeriesRole role, const BinnedCurve& curve) {
  return {name, role, SeriesStyle::line_and_points, curve.x, curve.mean, curve.lower, curve.upper, curve.samples};
}

}  // namespace host
