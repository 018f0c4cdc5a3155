#include "host/record/resample.hpp"

#include <algorithm>
#include <cmath>

namespace host {

std::vector<double> even_grid(double start_s, double end_s, double period_s) {
  constexpr double kSlack = 1e-6;
  const auto steps = static_cast<std::size_t>(std::floor((end_s - start_s) / period_s + kSlack));
  std::vector<double> grid(steps + 1);
  for (std::size_t k = 0; k <= steps; ++k) grid[k] = start_s + static_cast<double>(k) * period_s;
  return grid;
}

std::vector<double> interpolate(const StampedChannel& channel, const std::vector<double>& grid_s) {
  const std::vector<double>&t = channel.t_s, &v = channel.values;
  std::vector<double> values;
  values.reserve(grid_s.size());
  std::size_t right = 1;
  for (const double at : grid_s) {
    while (right + 1 < t.size() && t[right] < at) ++right;
    const double share = std::clamp((at - t[right - 1]) / (t[right] - t[right - 1]), 0.0, 1.0);
    values.push_back(v[right - 1] + share * (v[right] - v[right - 1]));
  }
  return values;
}

std::vector<double> mean_of_held(const StampedChannel& channel, const std::vector<double>& grid_s, double period_s) {
  const std::vector<double>&t = channel.t_s, &v = channel.values;
  std::vector<double> values;
  values.reserve(grid_s.size());
  std::size_t held = 0;
  for (const double start : grid_s) {
    const double end = start + period_s;
    while (held + 1 < t.size() && t[held + 1] <= start) ++held;
    double sum = 0.0, from = start;
    std::size_t k = held;
    while (k + 1 < t.size() && t[k + 1] < end) {
      sum += v[k] * (t[k + 1] - from);
      from = t[++k];
    }
    values.push_back((sum + v[k] * (end - from)) / period_s);
  }
  return values;
}

}  // namespace host
