// Reduces the number of samples without losing a spike.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace host {

/// Rows (ascending) to keep of equally long series so that at most `max_rows` remain: of each stretch the smallest and
/// the largest value of every series, the first NaN (gaps stay gaps), and the two ends. All rows when they fit.
/// `max_rows` must be at least 3 * series + 2.
std::vector<std::size_t> decimated_rows(std::span<const std::span<const double>> series, std::size_t max_rows);

/// Rows (ascending) to keep of a cloud of points: half of `max_rows` evenly spread, so that its density shows, and half
/// extremes. The points must be sorted along the horizontal axis.
std::vector<std::size_t> thinned_cloud(std::span<const double> y, std::size_t max_rows);

}  // namespace host
