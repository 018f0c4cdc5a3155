// Checks that samples are evenly spaced. Records and imported logs have to meet the same criterion.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace host {

/// Largest deviation of a step from the sample period, relative to it. At the highest acceleration of a feed drive (10
/// m/s^2) and 1 ms, it causes a speed error of 0.1 um/s per microsecond, which is below the noise of any tachometer.
inline constexpr double kJitterTolerance = 0.01;

/// Steps longer than this many periods are gaps (dropped samples); shorter ones are jitter.
inline constexpr double kGapPeriods = 1.5;

/// Largest relative difference between the period in the header and that of t_s. Quartz clocks agree within 1e-4.
inline constexpr double kPeriodTolerance = 1e-3;

struct TimeAxis {
  const std::vector<double>& t_s;
  double stamp_resolution_s;  ///< weight of the last digit of the stamps in the file; 0 if exact
  std::size_t first_line;     ///< line of row 0 in the file; 0 if there are no lines
};

struct Spacing {
  double period_s = 0.0;        ///< mean of the steps without gaps and repeats
  double rms_jitter_s = 0.0;    ///< RMS deviation of these steps from the period
  double worst_jitter_s = 0.0;  ///< largest deviation of these steps from the period
  std::size_t gaps = 0;
  std::size_t dropped = 0;        ///< number of missing samples in all gaps
  std::size_t first_gap_row = 0;  ///< the row after the first gap
  std::size_t worst_jitter_row = 0;
  bool is_even = false;  ///< true if there are no gaps and every step is within tolerance
};

/// Throws Failure(bad_input), with the line, if time does not increase. Needs at least two rows.
void check_time_increases(const TimeAxis& axis, const std::string& path);

/// Measures how evenly the stamps are spaced. They must increase.
Spacing measure_spacing(const TimeAxis& axis);

/// The sample period, s. Throws Failure(bad_input) if time does not increase, samples were dropped, steps have jitter,
/// or the period in the header (line `header_line`) contradicts the stamps.
double check_time_axis(const TimeAxis& axis, std::optional<double> header_period_s, std::size_t header_line,
                       const std::string& path);

}  // namespace host
