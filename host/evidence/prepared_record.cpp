#include "host/evidence/prepared_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/exit_codes.hpp"
#include "host/statistics.hpp"

namespace host {

namespace {

/// Standard deviation of the noise from third differences, which motion hardly affects and whose variance is twenty
/// times that of white noise. At least that of the quantisation of the channel.
double row_noise(const std::vector<double>& values) {
  std::vector<double> third, steps;
  for (std::size_t k = 3; k < values.size(); ++k) {
    const double change = std::abs(values[k] - 3.0 * values[k - 1] + 3.0 * values[k - 2] - values[k - 3]);
    if (std::isfinite(change)) third.push_back(change);
    if (const double step = std::abs(values[k] - values[k - 1]); step > 0.0) steps.push_back(step);
  }
  if (steps.empty() || third.empty()) return 0.0;
  constexpr double kMedian = 0.6745;  // median magnitude of a normal variable, in standard deviations
  return std::max(median(std::move(third)) / (kMedian * std::sqrt(20.0)), std::ranges::min(steps) / std::sqrt(12.0));
}

}  // namespace

PreparedRecord prepare(const Record& record, const sim::DriveDescription& base, double window_s) {
  const auto length = static_cast<std::size_t>(std::lround(window_s / record.sample_period_s));
  if (length < 2 || record.size() < length + 1)
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: {} samples of {} s are too few for a window of {} s; record longer or choose --window",
                    record.path, record.size(), record.sample_period_s, window_s));
  PreparedRecord prepared{&record,
                          command_volts(record, base.data),
                          HeldCommand(record, base.data),
                          record.u_V.empty() ? base.data.torque_constant_Nm_per_A * row_noise(record.i_A) : 0.0,
                          std::make_shared<const MotionSmoother>(record, base),
                          {},
                          record.sample_period_s,
                          nullptr};
  std::vector<ShiftWeights> weights;
  for (std::size_t begin = 0; begin + length < record.size(); begin += length) {
    prepared.windows.push_back({begin, length});
    weights.push_back(prepared.smoother->shift_weights(begin));
  }
  prepared.shift_weights = std::make_shared<const std::vector<ShiftWeights>>(std::move(weights));
  return prepared;
}

PreparedRecord in_long_windows(PreparedRecord prepared, double window_s) {
  const auto times = static_cast<std::size_t>(std::lround(window_s / prepared.window_s()));
  if (times < 2) return prepared;
  std::vector<Window> joined;
  const std::vector<Window>& all = prepared.windows;
  for (std::size_t k = 0; k + times <= all.size();) {
    const std::size_t length = all[k].length;
    const bool whole =
        (all[k].begin / length) % times == 0 && all[k + times - 1].begin == all[k].begin + (times - 1) * length;
    if (whole) joined.push_back({all[k].begin, times * length});
    k += whole ? times : 1;
  }
  std::vector<ShiftWeights> weights;
  for (std::size_t k = 0; k < prepared.shift_weights->size(); k += times)
    weights.push_back((*prepared.shift_weights)[k]);
  prepared.windows = std::move(joined);
  prepared.shift_weights = std::make_shared<const std::vector<ShiftWeights>>(std::move(weights));
  return prepared;
}

}  // namespace host
