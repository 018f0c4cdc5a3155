#include "host/compare/comparison.hpp"

#include <algorithm>
#include <cmath>

#include "host/statistics.hpp"

namespace host {

std::size_t RecordSet::used_windows() const {
  std::size_t count = 0;
  for (const ComparedRecord& compared : records) count += (compared.prepared.windows.size() + stride - 1) / stride;
  return count;
}

std::vector<const PreparedRecord*> prepared_records(const RecordSet& set) {
  std::vector<const PreparedRecord*> prepared;
  for (const ComparedRecord& compared : set.records) prepared.push_back(&compared.prepared);
  return prepared;
}

double first_stamp_s(const RecordSet& set) {
  double first_s = HUGE_VAL;
  for (const ComparedRecord& compared : set.records) first_s = std::min(first_s, compared.prepared.record->t_s.front());
  return set.records.empty() ? 0.0 : first_s;
}

double steps_of(const sim::Drive& drive, const RecordSet& set) {
  double steps = 0.0;
  for (const ComparedRecord& compared : set.records) {
    const PreparedRecord& prepared = compared.prepared;
    std::size_t samples = set.measure == Measure::effort ? prepared.u_V.size() : 0;
    if (set.measure == Measure::motion)
      for (std::size_t k = 0; k < prepared.windows.size(); k += set.stride) samples += prepared.windows[k].length;
    steps += static_cast<double>(samples) * std::max(1.0, std::ceil(prepared.period_s / drive.max_step_s));
  }
  return steps;
}

RecordSet compare_on(const std::vector<const Record*>& records, const sim::DriveDescription& reference, double window_s,
                     Measure measure) {
  RecordSet set;
  set.measure = measure;
  for (const Record* record : records) {
    set.records.push_back({prepare(*record, reference, window_s), {}});
    if (measure != Measure::effort) continue;
    PreparedRecord& prepared = set.records.back().prepared;
    const auto effort = std::make_shared<const EffortRecord>(prepare_effort(*record, reference));
    std::erase_if(prepared.windows, [&](const Window& window) {
      for (std::size_t k = window.begin + 1; k <= window.begin + window.length; ++k)
        if (!effort->counts[k] || prepared.motion().standing[k]) return true;
      return false;
    });
    set.records.back().effort = effort;
  }
  renew_floors(set, reference);
  return set;
}

RecordSet by_motion(const RecordSet& set, const sim::DriveDescription& reference) {
  RecordSet same = set;
  same.measure = Measure::motion;
  renew_floors(same, reference);
  return same;
}

namespace {

struct Predictions {
  Prediction motion;
  EffortPrediction effort;
};

/// Calls use(compared, record index, window index, predictions) for every used window.
template <typename Use>
void for_each_window(const sim::Drive& drive, const RecordSet& set, Use use) {
  static thread_local Predictions predictions;
  for (std::size_t r = 0; r < set.records.size(); ++r) {
    const ComparedRecord& compared = set.records[r];
    if (set.measure == Measure::effort) {
      predict_effort(drive, *compared.effort, predictions.effort);
    } else {
      predict(drive, compared.prepared, predictions.motion, set.stride);
    }
    for (std::size_t index = 0; index < compared.prepared.windows.size(); index += set.stride)
      use(compared, r, index, predictions);
  }
}

/// Calls use(score's member, predicted, measured, floor) for every channel of a window.
template <typename Use>
void for_each_channel(const ComparedRecord& compared, Measure measure, std::size_t index,
                      const Predictions& predictions, Use use) {
  const auto& [prepared, floor, effort] = compared;
  if (measure == Measure::effort) {
    use(&WindowScore::effort, predictions.effort.needed, predictions.effort.given, effort->floor);
    return;
  }
  if (!floor.x.empty()) use(&WindowScore::x, predictions.motion.x, prepared.record->x, floor.x[index]);
  if (!floor.w.empty()) use(&WindowScore::w, predictions.motion.w, prepared.record->w, floor.w[index]);
}

double mean_square(const std::vector<double>& predicted, const std::vector<double>& measured, const Window& window) {
  double sum = 0.0;
  for (std::size_t k = window.begin + 1; k <= window.begin + window.length; ++k)
    sum += (predicted[k] - measured[k]) * (predicted[k] - measured[k]);
  return sum / static_cast<double>(window.length);
}

/// A diverging model gets the largest error, which is a finite number.
double bounded(double square, double floor) {
  constexpr double kRunAway = 1e6;  // noise floors
  const double most = kRunAway * kRunAway * floor * floor;
  return square < most ? square : most;
}

struct ChannelScore {
  std::size_t window;  ///< index in SetError::windows
  double square;       ///< mean squared error over squared noise floor
  double floor;
};

/// Fills log_loss and window_log_loss.
void add_log_loss(const std::vector<ChannelScore>& scores, SetError& error) {
  constexpr double kDegrees = 4.0;  // of the t distribution (Lange et al. 1989)
  constexpr int kRounds = 30;       // of the fixed point for the scale of a t distribution
  const auto count = static_cast<double>(scores.size());
  error.window_log_loss.assign(error.windows.size(), 0.0);
  if (scores.empty()) return;
  double scale = 1.0;  // squared, over the noise floors
  for (int round = 0; round < kRounds; ++round) {
    double sum = 0.0;
    for (const ChannelScore& score : scores) sum += (kDegrees + 1.0) * score.square / (kDegrees + score.square / scale);
    scale = std::max(1.0, sum / count);
  }
  double sum = 0.0;
  for (const ChannelScore& score : scores) {
    const double loss = std::log(score.floor) + 0.5 * std::log(scale) +
                        0.5 * (kDegrees + 1.0) * std::log1p(score.square / (kDegrees * scale));
    error.window_log_loss[score.window] += loss;
    sum += loss;
  }
  error.log_loss = std::isfinite(sum) ? sum / count : HUGE_VAL;
}

}  // namespace

void renew_floors(RecordSet& set, const sim::DriveDescription& reference) {
  const sim::Drive drive(reference);
  std::vector<double> squares;
  if (set.measure == Measure::motion)
    for (ComparedRecord& compared : set.records)
      renew_floor(compared.floor, reference, drive, compared.prepared, set.stride);
  for (const WindowScore& score : error_of(drive, set).windows)
    for (const double square : {score.x, score.w, score.effort})
      if (square > 0.0) squares.push_back(square);
  if (squares.empty()) return;
  set.common_square = kCommonSquare * std::max(1.0, median(std::move(squares)));
}

double WindowScore::weighed(double common_square) const {
  return weighed_square(x, common_square) + weighed_square(w, common_square) + weighed_square(effort, common_square);
}

double weighed_square(double square, double common_square) {
  return common_square * std::log1p(square / common_square);
}

SetError error_of(const sim::Drive& drive, const RecordSet& set) {
  SetError error;
  struct Sum {
    double square = 0.0, floor = 0.0;
    std::size_t count = 0;
  };
  Sum x, w, effort;
  double combined = 0.0, robust = 0.0;
  std::vector<ChannelScore> scores;
  for_each_window(
      drive, set,
      [&](const ComparedRecord& compared, std::size_t r, std::size_t index, const Predictions& predictions) {
        WindowScore score{r, index};
        for_each_channel(compared, set.measure, index, predictions,
                         [&](double WindowScore::*member, const std::vector<double>& predicted,
                             const std::vector<double>& measured, double floor) {
                           Sum& sum = member == &WindowScore::x ? x : (member == &WindowScore::w ? w : effort);
                           const double square =
                               bounded(mean_square(predicted, measured, compared.prepared.windows[index]), floor);
                           score.*member = square / (floor * floor);
                           sum.square += square;
                           sum.floor += floor * floor;
                           ++sum.count;
                           scores.push_back({error.windows.size(), score.*member, floor});
                         });
        combined += score.x + score.w + score.effort;
        robust += score.weighed(set.common_square);
        error.windows.push_back(score);
      });
  const auto root_mean = [](double sum, std::size_t count) {
    const double mean = count == 0 ? 0.0 : sum / static_cast<double>(count);
    return std::isfinite(mean) ? std::sqrt(mean) : HUGE_VAL;  // a diverging model has the largest possible error
  };
  const std::size_t channels = x.count + w.count + effort.count;
  error.combined = root_mean(combined, channels);
  error.robust = root_mean(robust, channels);
  add_log_loss(scores, error);
  error.x_rms = root_mean(x.square, x.count);
  error.w_rms = root_mean(w.square, w.count);
  error.x_floor = root_mean(x.floor, x.count);
  error.w_floor = root_mean(w.floor, w.count);
  error.effort_rms = root_mean(effort.square, effort.count);
  error.effort_floor = root_mean(effort.floor, effort.count);
  return error;
}

SetError error_over_own_floors(const sim::DriveDescription& model, const RecordSet& set) {
  RecordSet own = set;
  renew_floors(own, model);
  return error_of(sim::Drive(model), own);
}

std::size_t channel_count(const ComparedRecord& compared, Measure measure) {
  if (measure == Measure::effort) return 1;
  return (compared.floor.x.empty() ? 0 : 1) + (compared.floor.w.empty() ? 0 : 1);
}

std::size_t residual_count(const RecordSet& set) {
  std::size_t count = 0;
  for (const ComparedRecord& compared : set.records) {
    const std::size_t channels = channel_count(compared, set.measure);
    const auto& windows = compared.prepared.windows;
    for (std::size_t index = 0; index < windows.size(); index += set.stride) count += channels * windows[index].length;
  }
  return count;
}

void residuals_of(const sim::Drive& drive, const RecordSet& set, double* out) {
  std::size_t channels = 0;
  for (const ComparedRecord& compared : set.records) {
    const std::size_t used = (compared.prepared.windows.size() + set.stride - 1) / set.stride;
    channels += used * channel_count(compared, set.measure);
  }
  for_each_window(
      drive, set, [&](const ComparedRecord& compared, std::size_t, std::size_t index, const Predictions& predictions) {
        const Window& window = compared.prepared.windows[index];
        const double share = 1.0 / std::sqrt(static_cast<double>(channels * window.length));
        for_each_channel(compared, set.measure, index, predictions,
                         [&](double WindowScore::*, const std::vector<double>& predicted,
                             const std::vector<double>& measured, double floor) {
                           const double square = mean_square(predicted, measured, window) / (floor * floor);
                           const double weight =
                               square > 0.0 ? std::sqrt(weighed_square(square, set.common_square) / square) : 1.0;
                           for (std::size_t k = window.begin + 1; k <= window.begin + window.length; ++k)
                             *out++ = (predicted[k] - measured[k]) * share / floor * weight;
                         });
      });
}

}  // namespace host
