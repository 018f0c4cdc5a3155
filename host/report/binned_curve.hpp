// A cloud of samples as a curve: the mean in bins along a coordinate, with the spread.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "host/report/content.hpp"

namespace host {

/// One entry per bin, in ascending x. Where a stretch of the coordinate holds no samples, one entry of NaN stands
/// between the bins on both sides: a line drawn through them breaks there.
struct BinnedCurve {
  std::vector<double> x;        ///< mean coordinate of the bin's samples
  std::vector<double> mean;     ///< mean value
  std::vector<double> lower;    ///< 10 % quantile of the values
  std::vector<double> upper;    ///< 90 % quantile of the values
  std::vector<double> samples;  ///< in the bin
};

/// About the wanted width (> 0), so that a ripple of this period does not alias in the means: a whole number of
/// periods, over which it averages out, or a whole part of one that is small enough to show it. Period 0: as wanted.
double bin_width(double wanted, double period);

/// Bins are as wide as the range of x over `bins`, by bin_width() for the period, or wider until they hold
/// `min_samples`; what is left at the end of a stretch joins the bin before it. Five widths without a sample end a
/// stretch; one with fewer than `min_samples` in all is left out. Samples with a NaN are left out.
BinnedCurve binned_curve(std::span<const double> x, std::span<const double> y, std::size_t bins,
                         std::size_t min_samples = 10, double period = 0.0);

/// As points that a line joins, with the spread as its band.
ScatterSeries curve_series(const std::string& name, SeriesRole role, const BinnedCurve& curve);

}  // namespace host
