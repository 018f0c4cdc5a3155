// A cloud of samples as a curve: the mean in bins along a coordinate, with the spread.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace host {

/// One entry per bin that holds enough samples, in ascending x.
struct BinnedCurve {
  std::vector<double> x;      ///< mean coordinate of the bin's samples
  std::vector<double> mean;   ///< mean value
  std::vector<double> lower;  ///< 10 % quantile of the values
  std::vector<double> upper;  ///< 90 % quantile of the values
};

/// Bins of equal width between the smallest and the largest finite x. Samples with a NaN are left out, bins with fewer
/// than `min_samples` too.
BinnedCurve binned_curve(std::span<const double> x, std::span<const double> y, std::size_t bins,
                         std::size_t min_samples = 10);

}  // namespace host
