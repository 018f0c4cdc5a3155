// Scattered samples as a curve: the mean in bins along a coordinate, with the spread.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "host/report/content.hpp"

namespace host {

/// One entry per bin, by ascending x. An interval of the coordinate without samples has one entry of NaN, at which a
/// line breaks.
struct BinnedCurve {
  std::vector<double> x;        ///< mean coordinate of the bin's samples
  std::vector<double> mean;     ///< mean value
  std::vector<double> lower;    ///< 10 % quantile of the values
  std::vector<double> upper;    ///< 90 % quantile of the values
  std::vector<double> samples;  ///< number of samples in the bin
};

/// A bin width close to the wanted one (> 0) with which a ripple of this period does not alias in the means: a whole
/// number of periods, which averages out the ripple, or a whole fraction of a period that is small enough to show it.
/// Period 0: the wanted width.
double bin_width(double wanted, double period);

/// The width of a bin is the range of x over `bins`, adapted to the period by bin_width(). A bin is wider if it would
/// otherwise contain fewer than `min_samples`. Samples left over at the end of an interval join the last bin. An
/// interval ends after five bin widths without a sample. Intervals with fewer than `min_samples` samples and samples
/// with a NaN are left out.
BinnedCurve binned_curve(std::span<const double> x, std::span<const double> y, std::size_t bins,
                         std::size_t min_samples = 10, double period = 0.0);

/// The curve as points joined by a line, with the spread as a band.
ScatterSeries curve_series(const std::string& name, SeriesRole role, const BinnedCurve& curve);

}  // namespace host
