#include "host/evidence/channel_relations.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "host/identify/encoder_step.hpp"
#include "host/statistics.hpp"

namespace host {

namespace {

/// Correlation (about zero) between the change of `path` over blocks and the sum of `rate` over the same blocks.
double follows(const std::vector<double>& path, const std::vector<double>& rate) {
  constexpr std::size_t kBlock = 10;  // rows; long enough to average out the noise
  double pp = 0.0, pr = 0.0, rr = 0.0;
  for (std::size_t k = kBlock; k < path.size(); k += kBlock) {
    double sum = 0.5 * (rate[k - kBlock] + rate[k]);
    for (std::size_t j = k - kBlock + 1; j < k; ++j) sum += rate[j];
    const double change = path[k] - path[k - kBlock];
    pp += change * change;
    pr += change * sum;
    rr += sum * sum;
  }
  return pp > 0.0 && rr > 0.0 ? pr / std::sqrt(pp * rr) : 0.0;
}

struct AffineFit {
  double factor = 0.0;
  double left = 1.0;   ///< unexplained part of the variance
  double worst = 1.0;  ///< largest residual over the channel's range
};

AffineFit affine_fit(const std::vector<double>& of, const std::vector<double>& by) {
  const auto n = static_cast<double>(of.size());
  double mean_of = 0.0, mean_by = 0.0;
  for (std::size_t k = 0; k < of.size(); ++k) {
    mean_of += of[k] / n;
    mean_by += by[k] / n;
  }
  double bb = 0.0, ob = 0.0, oo = 0.0;
  for (std::size_t k = 0; k < of.size(); ++k) {
    const double o = of[k] - mean_of, b = by[k] - mean_by;
    bb += b * b;
    ob += o * b;
    oo += o * o;
  }
  AffineFit fit;
  if (is_constant(of) || is_constant(by)) return fit;  // their variance is a rounding error
  if (!(bb > 0.0) || !(oo > 0.0) || !std::isfinite(bb) || !std::isfinite(oo)) return fit;
  fit.factor = ob / bb;
  fit.worst = 0.0;
  double left = 0.0, low = 0.0, high = 0.0;
  for (std::size_t k = 0; k < of.size(); ++k) {
    const double o = of[k] - mean_of, residual = o - fit.factor * (by[k] - mean_by);
    left += residual * residual;
    fit.worst = std::max(fit.worst, std::abs(residual));
    low = std::min(low, o);
    high = std::max(high, o);
  }
  fit.left = left / oo;
  fit.worst /= high - low;
  return fit;
}

/// Whether a channel differs from another one times a factor by more than the rounding of both when they were written:
/// in rows in which the other one has the same value, or by more than the smallest steps of both.
bool exceeds_rounding(const std::vector<double>& of, const std::vector<double>& by, const AffineFit& fit) {
  std::vector<std::pair<double, double>> rows;
  for (std::size_t k = 0; k < of.size(); ++k) rows.emplace_back(by[k], of[k]);
  std::ranges::sort(rows);
  std::vector<double> sorted = of;
  std::ranges::sort(sorted);
  constexpr double kSameValue = 1e-9;  // of the range: rounding errors of the computation
  const double range = sorted.back() - sorted.front(), same = kSameValue * range;
  double step_of = range, step_by = range / std::abs(fit.factor);
  for (std::size_t k = 1; k < rows.size(); ++k) {
    if (sorted[k] - sorted[k - 1] > same) step_of = std::min(step_of, sorted[k] - sorted[k - 1]);
    const double step = rows[k].first - rows[k - 1].first;
    if (step * std::abs(fit.factor) > same)
      step_by = std::min(step_by, step);
    else if (rows[k].second - rows[k - 1].second > same)
      return true;
  }
  return fit.worst * range > step_of + step_by * std::abs(fit.factor) + same;
}

}  // namespace

bool position_and_speed_swapped(const Record& record) {
  constexpr double kFollows = 0.9, kDoesNot = 0.7;
  if (!record.has_position() || !record.has_speed()) return false;
  return follows(record.w, record.x) > kFollows && std::abs(follows(record.x, record.w)) < kDoesNot;
}

std::optional<ScaledCopy> scaled_copy(const Record& record) {
  constexpr double kSame = 1e-6;  // of the variance: a thousandth of the channel's size
  constexpr double kSameExactly =
      1e-9;  // of the range: rounding errors only, since a good servo also follows to a thousandth
  using Channel = std::vector<double> Record::*;
  constexpr Channel kChannels[] = {&Record::u_V, &Record::i_A, &Record::x, &Record::w, &Record::x_ref, &Record::w_ref};
  const auto is_reference = [](Channel channel) { return channel == &Record::x_ref || channel == &Record::w_ref; };
  for (const Channel original : kChannels) {
    for (const Channel channel : kChannels) {
      if (channel == original) break;
      if ((record.*channel).empty() || (record.*original).empty()) continue;
      if (is_reference(channel) && is_reference(original)) continue;
      const AffineFit fit = affine_fit(record.*original, record.*channel);
      const bool tight = is_reference(channel) || is_reference(original);
      if (tight ? fit.worst > kSameExactly : fit.left > kSame) continue;
      const bool harmless = channel == &Record::u_V && original == &Record::i_A;
      // An amplifier's measured current follows the command to a thousandth, too.
      if (harmless && exceeds_rounding(record.*original, record.*channel, fit)) continue;
      return ScaledCopy{original, channel, fit.factor, harmless};
    }
  }
  return std::nullopt;
}

bool speed_is_differenced(const Record& record, const sim::DataSheet& data) {
  if (!record.has_position() || !record.has_speed() || record.size() < 4) return false;
  constexpr double kSame = 1e-3;  // of one encoder step per sample: tachometer noise is not a multiple of the step
  const double unit = encoder_step(record, data) / (data.lead * record.sample_period_s);
  if (!(unit > 0.0)) return false;
  const auto departs = [&](std::size_t back, std::size_t ahead) {
    const double span_s = static_cast<double>(back + ahead) * record.sample_period_s;
    double travel = 0.0;
    for (std::size_t k = back; k + ahead < record.size(); ++k) {
      const double difference = (record.x[k + ahead] - record.x[k - back]) / (data.lead * span_s);
      travel = std::max(travel, std::abs(difference));
      if (std::abs(record.w[k] - difference) > kSame * unit) return true;
    }
    return travel == 0.0;
  };
  return !departs(1, 0) || !departs(0, 1) || !departs(1, 1);
}

}  // namespace host
