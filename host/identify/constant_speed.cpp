#include "host/identify/constant_speed.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

#include "host/identify/encoder_step.hpp"

namespace host {

namespace {

constexpr double kSmoothing_s = 0.1;

/// Speed smoothed over 2*half samples about each sample, and its uncertainty due to sensor resolution or noise.
struct SmoothedSpeed {
  std::vector<double> value;  ///< value[k] belongs to sample k + half
  std::size_t half = 1;
  double uncertainty = 0.0;
};

SmoothedSpeed smooth(const Record& record, const sim::DataSheet& data) {
  SmoothedSpeed smoothed;
  smoothed.half = std::max<std::size_t>(1, static_cast<std::size_t>(0.5 * kSmoothing_s / record.sample_period_s));
  const std::size_t width = 2 * smoothed.half;
  if (record.size() <= width) return smoothed;
  const double span_s = record.sample_period_s * static_cast<double>(width);
  if (record.has_position()) {
    for (std::size_t k = 0; k + width < record.size(); ++k) {
      smoothed.value.push_back((record.x[k + width] - record.x[k]) / (span_s * data.lead));
    }
    smoothed.uncertainty = encoder_step(record, data) / (span_s * data.lead);
    return smoothed;
  }
  double sum = 0.0;
  for (std::size_t k = 0; k < width; ++k) sum += record.w[k];
  for (std::size_t k = 0; k + width < record.size(); ++k) {
    smoothed.value.push_back(sum / static_cast<double>(width));
    sum += record.w[k + width] - record.w[k];
  }
  const double variance = data.tach_noise_variance.value_or(0.0);
  smoothed.uncertainty = 3.0 * std::sqrt(variance / static_cast<double>(width));
  return smoothed;
}

/// For each start: whether the speed stays within the tolerance over the next `length` values (sliding minimum and
/// maximum).
std::vector<bool> steady_starts(const SmoothedSpeed& speed, std::size_t length, double tolerance) {
  std::vector<bool> steady(speed.value.size() >= length ? speed.value.size() - length + 1 : 0);
  std::deque<std::size_t> highs, lows;
  const auto push = [&](std::deque<std::size_t>& queue, std::size_t k, auto beats) {
    while (!queue.empty() && beats(speed.value[k], speed.value[queue.back()])) queue.pop_back();
    queue.push_back(k);
    while (queue.front() + length <= k) queue.pop_front();
  };
  for (std::size_t k = 0; k < speed.value.size(); ++k) {
    push(highs, k, [](double a, double b) { return a >= b; });
    push(lows, k, [](double a, double b) { return a <= b; });
    if (k + 1 < length) continue;
    const double high = speed.value[highs.front()], low = speed.value[lows.front()];
    const double middle = 0.5 * std::abs(high + low);
    const bool moves = middle > 2.0 * speed.uncertainty && high * low > 0.0;
    steady[k + 1 - length] = moves && high - low <= 2.0 * (tolerance * middle + 1.5 * speed.uncertainty);
  }
  return steady;
}

double mean_speed(const Record& record, const sim::DataSheet& data, std::size_t begin, std::size_t end) {
  if (record.has_position()) {
    const double duration_s = record.sample_period_s * static_cast<double>(end - 1 - begin);
    return (record.x[end - 1] - record.x[begin]) / (duration_s * data.lead);
  }
  double sum = 0.0;
  for (std::size_t k = begin; k < end; ++k) sum += record.w[k];
  return sum / static_cast<double>(end - begin);
}

}  // namespace

std::vector<ConstantSpeed> find_constant_speeds(const Record& record, const sim::DataSheet& data,
                                                const ConstantSpeedOptions& options) {
  const SmoothedSpeed speed = smooth(record, data);
  // A window of `length` smoothed values depends on a part of the record that is longer by kSmoothing_s.
  const double length_s = std::max(options.shortest_s - kSmoothing_s, 0.05);
  const auto length = static_cast<std::size_t>(length_s / record.sample_period_s);
  const std::vector<bool> steady = steady_starts(speed, std::max<std::size_t>(2, length), options.tolerance);

  std::vector<ConstantSpeed> found;
  const auto settle = static_cast<std::size_t>(options.settle_s / record.sample_period_s);
  for (std::size_t k = 0; k < steady.size(); ++k) {
    if (!steady[k]) continue;
    const std::size_t first = k;
    const bool forward = speed.value[k] > 0.0;
    while (k + 1 < steady.size() && steady[k + 1] && (speed.value[k + 1] > 0.0) == forward) ++k;
    ConstantSpeed stretch;
    stretch.begin = first + speed.half;
    stretch.end = std::min(k + length + speed.half, record.size());
    stretch.begin += std::min(settle, (stretch.end - stretch.begin) / 2);
    if (stretch.end - stretch.begin < 20) continue;
    stretch.speed = mean_speed(record, data, stretch.begin, stretch.end);
    found.push_back(stretch);
  }
  return found;
}

}  // namespace host
