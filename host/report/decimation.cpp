#include "host/report/decimation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace host {

namespace {

/// Appends the indices of the smallest and largest value of `values[from, to)`, and of its first NaN.
void append_extremes(std::span<const double> values, std::size_t from, std::size_t to, std::vector<std::size_t>& rows) {
  std::size_t lowest = to;
  std::size_t highest = to;
  std::size_t first_gap = to;
  for (std::size_t row = from; row < to; ++row) {
    if (std::isnan(values[row])) {
      first_gap = std::min(first_gap, row);
      continue;
    }
    if (lowest == to || values[row] < values[lowest]) lowest = row;
    if (highest == to || values[row] > values[highest]) highest = row;
  }
  for (const std::size_t row : {lowest, highest, first_gap}) {
    if (row < to) rows.push_back(row);
  }
}

void sort_unique(std::vector<std::size_t>& rows) {
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
}

std::vector<std::size_t> all_rows(std::size_t count) {
  std::vector<std::size_t> rows(count);
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  return rows;
}

}  // namespace

std::vector<std::size_t> decimated_rows(std::span<const std::span<const double>> series, std::size_t max_rows) {
  const std::size_t count = series.empty() ? 0 : series.front().size();
  if (count <= max_rows) return all_rows(count);
  const std::size_t stretches = std::max<std::size_t>(1, (max_rows - 2) / (3 * series.size()));
  std::vector<std::size_t> rows = {0, count - 1};
  for (std::size_t stretch = 0; stretch < stretches; ++stretch) {
    const std::size_t from = count * stretch / stretches;
    const std::size_t to = count * (stretch + 1) / stretches;
    for (const std::span<const double>& values : series) append_extremes(values, from, to, rows);
  }
  sort_unique(rows);
  return rows;
}

std::vector<std::size_t> thinned_cloud(std::span<const double> y, std::size_t max_rows) {
  if (y.size() <= max_rows) return all_rows(y.size());
  std::vector<std::size_t> rows = decimated_rows({&y, 1}, max_rows / 2);
  const std::size_t evenly = max_rows / 2;
  for (std::size_t k = 0; k < evenly; ++k) rows.push_back(y.size() * k / evenly);
  sort_unique(rows);
  return rows;
}

}  // namespace host
