// Reduces the number of samples and keeps every spike.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace host {

/// Rows (ascending) to keep of series of equal length, so that at most `max_rows` remain: the two ends and, of each
/// interval, the smallest and the largest value of every series and the first NaN (so gaps remain). All rows if they
/// are few enough. `max_rows` must be at least 3 * series + 2.
std::vector<std::size_t> decimated_rows(std::span<const std::span<const double>> series, std::size_t max_rows);

/// Rows (ascending) to keep of a cloud of points: half of `max_rows` evenly spread to show the density, and half
/// extremes. The points must be sorted along the horizontal axis.
std::vector<std::size_t> thinned_cloud(std::span<const double> y, std::size_t max_rows);

}  // namespace host
