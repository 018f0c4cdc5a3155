// Scattered samples as a curve: the mean in bins along a coordinate, with the spread.
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

/// A bin width close to the wanted one (> 0) with which a ripple of this period does not alias in the means: a whole
/// number of periods, which averages it out, or a whole fraction of one that is small enough to show it. Period 0: the
/// wanted width.
double bin_width(double wanted, double period);

/// The width of a bin is the range of x over `bins`, adapted by bin_width() to the period; a bin is wider if it would
/// otherwise hold fewer than `min_samples`. Remaining samples at the end of a stretch join the last bin. Five widths
/// without a sample end a stretch; a stretch with fewer than `min_samples` in all is left out, and so are samples with
/// a NaN.
BinnedCurve binned_curve(std::span<const double> x, std::span<const double> y, std::size_t bins,
                         std::size_t min_samples = 10, double period = 0.0);

/// As points joined by a line, with the spread as a band.
ScatterSeries curve_series(const std::string& name, SeriesRole role, const BinnedCurve& curve);

}  // namespace host
