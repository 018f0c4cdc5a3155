#include "host/record/time_axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/exit_codes.hpp"
#include "host/record/log_fault.hpp"
#include "host/statistics.hpp"

namespace host {

namespace {

std::string where(const TimeAxis& axis, std::size_t row) {
  return axis.first_line > 0 ? fmt::format("line {}, column t_s", axis.first_line + row)
                             : fmt::format("sample {} of t_s", row + 1);
}

double median_step(const std::vector<double>& t_s) {
  std::vector<double> steps(t_s.size() - 1);
  for (std::size_t k = 0; k < steps.size(); ++k) steps[k] = t_s[k + 1] - t_s[k];
  return median(std::move(steps));
}

/// Error of a step due to rounding of the stamps alone. There is none if the period is a multiple of the last digit.
double rounding_of_a_step(const TimeAxis& axis, double period_s) {
  if (!(axis.stamp_resolution_s > 0.0) || !std::isfinite(axis.stamp_resolution_s)) return 0.0;
  const double digits = period_s / axis.stamp_resolution_s;
  return std::abs(digits - std::round(digits)) < 1e-3 ? 0.0 : axis.stamp_resolution_s;
}

/// The period rounded to as few digits as describe it, as a person would write it.
double round_period(double period_s) {
  constexpr double kNear = 2e-3;
  for (int digits = 0; digits < 6; ++digits) {
    const double unit = std::pow(10.0, std::floor(std::log10(period_s)) - digits);
    const double rounded = std::round(period_s / unit) * unit;
    if (std::abs(rounded - period_s) <= kNear * period_s) return rounded;
  }
  return period_s;
}

}  // namespace

void check_time_increases(const TimeAxis& axis, const std::string& path) {
  const std::vector<double>& t = axis.t_s;
  for (std::size_t k = 1; k < t.size(); ++k) {
    if (t[k] > t[k - 1]) continue;
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: {}: time does not increase: {} s after {} s; remove the repeated row, or cut the "
                              "record where the clock was set back",
                              path, where(axis, k), t[k], t[k - 1]));
  }
}

Spacing measure_spacing(const TimeAxis& axis) {
  const std::vector<double>& t = axis.t_s;
  const double typical = median_step(t);
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 1; k < t.size(); ++k) {
    const double step = t[k] - t[k - 1];
    if (step > kGapPeriods * typical || step < typical / kGapPeriods) continue;
    sum += step;
    ++count;
  }
  Spacing spacing;
  spacing.period_s = sum / static_cast<double>(count);
  const double tolerance = std::min(kJitterTolerance * spacing.period_s + rounding_of_a_step(axis, spacing.period_s),
                                    0.1 * spacing.period_s);
  double squares = 0.0;
  std::size_t near = 0;
  for (std::size_t k = 1; k < t.size(); ++k) {
    const double step = t[k] - t[k - 1];
    if (step > kGapPeriods * spacing.period_s) {
      if (spacing.gaps++ == 0) spacing.first_gap_row = k;
      spacing.dropped += static_cast<std::size_t>(std::min(std::round(step / spacing.period_s) - 1.0, 1e15));
      continue;
    }
    const double jitter = std::abs(step - spacing.period_s);
    squares += jitter * jitter;
    ++near;
    if (jitter > spacing.worst_jitter_s) spacing.worst_jitter_s = jitter, spacing.worst_jitter_row = k;
  }
  spacing.rms_jitter_s = near > 0 ? std::sqrt(squares / static_cast<double>(near)) : 0.0;
  spacing.is_even = spacing.gaps == 0 && spacing.worst_jitter_s <= tolerance;
  return spacing;
}

double check_time_axis(const TimeAxis& axis, std::optional<double> header_period_s, std::size_t header_line,
                       const std::string& path) {
  const auto fail = [&](const std::string& what) {
    throw Failure(ExitCode::bad_input, fmt::format("{}: {}", path, what));
  };
  if (axis.t_s.size() < 2) {
    if (header_period_s) return *header_period_s;
    fail(fmt::format("{}: a single row has no sample period; record for longer", where(axis, 0)));
  }
  check_time_increases(axis, path);
  const Spacing spacing = measure_spacing(axis);
  if (header_period_s && std::abs(*header_period_s - spacing.period_s) >
                             kPeriodTolerance * *header_period_s + spacing.worst_jitter_s * 0.5)
    fail(fmt::format(
        "{}sample_period_s: {} s contradicts t_s, which advances by {:.6g} s per row; correct the wrong one",
        header_line > 0 ? fmt::format("line {}: ", header_line) : "", *header_period_s, spacing.period_s));
  const std::string jitter =
      fmt::format("{:.3g} ms rms, {:.3g} ms at worst, with a period of {:.6g} ms", spacing.rms_jitter_s * 1e3,
                  spacing.worst_jitter_s * 1e3, spacing.period_s * 1e3);
  if (spacing.gaps > 0) {
    const double from_s = axis.t_s[spacing.first_gap_row - 1];
    const std::string message = fmt::format(
        "{}: {}: dropped samples: {:.6g} s pass between two rows (first of {} gap(s), {} sample(s) missing; steps "
        "jitter by {}); record again, cut the record at the gaps (axistool cut), or accept interpolation with axistool "
        "import --resample {:.6g}",
        path, where(axis, spacing.first_gap_row), axis.t_s[spacing.first_gap_row] - from_s, spacing.gaps,
        spacing.dropped, jitter, round_period(spacing.period_s));
    throw FaultyLog(
        message, {{LogFaultKind::dropped_samples, "t_s", path, from_s, static_cast<double>(spacing.dropped), message}});
  }
  if (!spacing.is_even)
    fail(
        fmt::format("{}: uneven sampling: steps jitter by {}; record with a steady clock, or make an evenly sampled "
                    "record with axistool import --resample {:.6g}",
                    where(axis, spacing.worst_jitter_row), jitter, round_period(spacing.period_s)));
  if (header_period_s) return *header_period_s;
  constexpr double kPerPicosecond = 1e12;  // finer digits come from rounding of the stamps
  const double rounded = std::round(spacing.period_s * kPerPicosecond) / kPerPicosecond;
  return std::abs(rounded - spacing.period_s) < 0.01 * kPeriodTolerance * spacing.period_s ? rounded : spacing.period_s;
}

}  // namespace host
