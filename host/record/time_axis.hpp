// Checks that samples are evenly spaced, with the same criterion for records and imported logs.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace host {

/// A step may differ from the sample period by this share of it: at a feed drive's highest acceleration (10 m/s^2) and
/// 1 ms that is 0.1 um/s of speed error per microsecond, below any tachometer's noise.
inline constexpr double kJitterTolerance = 0.01;

/// Steps longer than this many periods are gaps (samples dropped), shorter ones jitter.
inline constexpr double kGapPeriods = 1.5;

/// The header's period and that of t_s may differ by this share: quartz clocks agree within 1e-4.
inline constexpr double kPeriodTolerance = 1e-3;

struct TimeAxis {
  const std::vector<double>& t_s;
  double stamp_resolution_s;  ///< weight of the last digit of the stamps in the file; 0: exact
  std::size_t first_line;     ///< line of the file that holds row 0; 0 where the file has no lines
};

struct Spacing {
  double period_s = 0.0;        ///< mean of the steps that are neither gaps nor repeats
  double rms_jitter_s = 0.0;    ///< of those steps about the period
  double worst_jitter_s = 0.0;  ///< of those steps about the period
  std::size_t gaps = 0;
  std::size_t dropped = 0;        ///< samples missing in all gaps together
  std::size_t first_gap_row = 0;  ///< the row after the first gap
  std::size_t worst_jitter_row = 0;
  bool is_even = false;  ///< no gaps, and every step within tolerance
};

/// Throws Failure(bad_input) where time does not increase, naming the line. Needs two rows at least.
void check_time_increases(const TimeAxis& axis, const std::string& path);

/// Measures how evenly increasing stamps are spaced.
Spacing measure_spacing(const TimeAxis& axis);

/// The sample period, s. Throws Failure(bad_input) where time does not increase, samples were dropped, steps jitter, or
/// the header's period (which stands in `header_line`) contradicts the stamps.
double check_time_axis(const TimeAxis& axis, std::optional<double> header_period_s, std::size_t header_line,
                       const std::string& path);

}  // namespace host
