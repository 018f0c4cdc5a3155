#include "host/insight/comparison.hpp"

#include <algorithm>
#include <cmath>

namespace host {

std::size_t RecordSet::used_windows() const {
  std::size_t count = 0;
  for (const ComparedRecord& compared : records) count += (compared.prepared.windows.size() + stride - 1) / stride;
  return count;
}

RecordSet compare_on(const std::vector<const Record*>& records, const sim::DriveDescription& reference,
                     double window_s) {
  RecordSet set;
  for (const Record* record : records) set.records.push_back({prepare(*record, reference, window_s), {}});
  renew_floors(set, reference);
  return set;
}

namespace {

/// Calls use(record index, window index, prediction) for every used window.
template <typename Use>
void for_each_window(const sim::Drive& drive, const RecordSet& set, Use use) {
  static thread_local Prediction prediction;
  for (std::size_t r = 0; r < set.records.size(); ++r) {
    const PreparedRecord& prepared = set.records[r].prepared;
    predict(drive, prepared, prediction, set.stride);
    for (std::size_t index = 0; index < prepared.windows.size(); index += set.stride) use(r, index, prediction);
  }
}

double mean_square(const std::vector<double>& predicted, const std::vector<double>& measured, const Window& window) {
  double sum = 0.0;
  for (std::size_t k = window.begin + 1; k <= window.begin + window.length; ++k)
    sum += (predicted[k] - measured[k]) * (predicted[k] - measured[k]);
  return sum / static_cast<double>(window.length);
}

}  // namespace

void renew_floors(RecordSet& set, const sim::DriveDescription& reference) {
  const sim::Drive drive(reference);
  std::vector<double> squares;
  for (ComparedRecord& compared : set.records) compared.floor = error_floor(drive, reference.data, compared.prepared);
  for (const WindowScore& score : error_of(drive, set).windows)
    for (const double square : {score.x, score.w})
      if (square > 0.0) squares.push_back(square);
  if (squares.empty()) return;
  const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
  std::ranges::nth_element(squares, middle);
  set.common_square = kCommonSquare * std::max(1.0, *middle);
}

double weighed_square(double square, double common_square) {
  return common_square * std::log1p(square / common_square);
}

SetError error_of(const sim::Drive& drive, const RecordSet& set) {
  SetError error;
  double x_sum = 0.0, w_sum = 0.0, x_floor = 0.0, w_floor = 0.0, combined = 0.0, robust = 0.0;
  std::size_t x_count = 0, w_count = 0;
  for_each_window(drive, set, [&](std::size_t r, std::size_t index, const Prediction& prediction) {
    const auto& [prepared, floor] = set.records[r];
    const Window& window = prepared.windows[index];
    WindowScore score{r, index};
    if (!floor.x.empty()) {
      const double square = mean_square(prediction.x, prepared.record->x, window);
      score.x = square / (floor.x[index] * floor.x[index]);
      x_sum += square;
      x_floor += floor.x[index] * floor.x[index];
      ++x_count;
    }
    if (!floor.w.empty()) {
      const double square = mean_square(prediction.w, prepared.record->w, window);
      score.w = square / (floor.w[index] * floor.w[index]);
      w_sum += square;
      w_floor += floor.w[index] * floor.w[index];
      ++w_count;
    }
    combined += score.x + score.w;
    robust += weighed_square(score.x, set.common_square) + weighed_square(score.w, set.common_square);
    error.windows.push_back(score);
  });
  const auto root_mean = [](double sum, std::size_t count) {
    const double mean = count == 0 ? 0.0 : sum / static_cast<double>(count);
    return std::isfinite(mean) ? std::sqrt(mean) : HUGE_VAL;  // a model that runs away is as bad as can be
  };
  error.combined = root_mean(combined, x_count + w_count);
  error.robust = root_mean(robust, x_count + w_count);
  error.x_rms = root_mean(x_sum, x_count);
  error.w_rms = root_mean(w_sum, w_count);
  error.x_floor = root_mean(x_floor, x_count);
  error.w_floor = root_mean(w_floor, w_count);
  return error;
}

std::size_t residual_count(const RecordSet& set) {
  std::size_t count = 0;
  for (const ComparedRecord& compared : set.records) {
    const std::size_t channels = (compared.floor.x.empty() ? 0 : 1) + (compared.floor.w.empty() ? 0 : 1);
    const auto& windows = compared.prepared.windows;
    for (std::size_t index = 0; index < windows.size(); index += set.stride) count += channels * windows[index].length;
  }
  return count;
}

void residuals_of(const sim::Drive& drive, const RecordSet& set, double* out) {
  double channels = 0.0;
  for (const ComparedRecord& compared : set.records) {
    const std::size_t used = (compared.prepared.windows.size() + set.stride - 1) / set.stride;
    channels += static_cast<double>(used * ((compared.floor.x.empty() ? 0 : 1) + (compared.floor.w.empty() ? 0 : 1)));
  }
  for_each_window(drive, set, [&](std::size_t r, std::size_t index, const Prediction& prediction) {
    const auto& [prepared, floor] = set.records[r];
    const Window& window = prepared.windows[index];
    const double share = 1.0 / std::sqrt(channels * static_cast<double>(window.length));
    const auto append = [&](const std::vector<double>& predicted, const std::vector<double>& measured,
                            double deviation) {
      const double square = mean_square(predicted, measured, window) / (deviation * deviation);
      const double scale =
          share / deviation * (square > 0.0 ? std::sqrt(weighed_square(square, set.common_square) / square) : 1.0);
      for (std::size_t k = window.begin + 1; k <= window.begin + window.length; ++k)
        *out++ = (predicted[k] - measured[k]) * scale;
    };
    if (!floor.x.empty()) append(prediction.x, prepared.record->x, floor.x[index]);
    if (!floor.w.empty()) append(prediction.w, prepared.record->w, floor.w[index]);
  });
}

}  // namespace host
