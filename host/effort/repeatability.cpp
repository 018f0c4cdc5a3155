#include "host/effort/repeatability.hpp"

#include <algorithm>
#include <cmath>

namespace host {

namespace {

/// A motion repeats if its deviation is below this part of its own standard deviation.
constexpr double kSame = 0.02;
/// A period shorter than this is a vibration, s.
constexpr double kShortest_s = 0.5;
constexpr double kLeastSeconds = 2.0;

/// The shortest lag after which a signal repeats, in samples; 0 if it does not repeat.
std::size_t period_of(const std::vector<double>& signal, double sample_s) {
  constexpr std::size_t kPoints = 1500;
  const std::size_t stride = std::max<std::size_t>(1, signal.size() / kPoints);
  std::vector<double> thin;
  for (std::size_t k = 0; k < signal.size(); k += stride) thin.push_back(signal[k]);
  double mean = 0.0, spread = 0.0;
  for (const double value : thin) mean += value / static_cast<double>(thin.size());
  for (const double value : thin) spread += std::pow(value - mean, 2) / static_cast<double>(thin.size());
  const auto difference = [](const std::vector<double>& values, std::size_t lag) {
    double sum = 0.0;
    for (std::size_t k = 0; k + lag < values.size(); ++k) sum += std::pow(values[k + lag] - values[k], 2);
    return sum / static_cast<double>(values.size() - lag);
  };
  const auto shortest = static_cast<std::size_t>(std::ceil(kShortest_s / (sample_s * static_cast<double>(stride))));
  // In the thinned signal a lag may be wrong by a part of a sample, so its limit is wider; the full sample rate
  // decides.
  constexpr double kThinned = 25.0;
  for (std::size_t lag = std::max<std::size_t>(2, shortest); lag + lag / 4 + 2 < thin.size(); ++lag) {
    const double here = difference(thin, lag);
    if (here > kThinned * kSame * kSame * spread || here > difference(thin, lag - 1) ||
        here > difference(thin, lag + 1))
      continue;
    std::size_t best = lag * stride;
    double least = HUGE_VAL;
    for (std::size_t fine = (lag - 1) * stride; fine <= (lag + 1) * stride && fine < signal.size(); ++fine) {
      const double there = difference(signal, fine);
      if (there < least) {
        least = there;
        best = fine;
      }
    }
    if (least < kSame * kSame * spread) return best;
  }
  return 0;
}

}  // namespace

std::optional<Repeatability> repeatability(const EffortRows& rows, const Eigen::VectorXd& residual) {
  double seconds = 0.0, squares = 0.0, differences = 0.0;
  for (const EffortSignals& signals : rows.signals) {
    const std::size_t period = period_of(signals.motion, signals.period_s);
    if (period == 0 || signals.kept.size() < 2) continue;
    const std::size_t stride = signals.kept[1] - signals.kept[0];
    for (std::size_t n = 0; n < signals.kept.size(); ++n) {
      const std::size_t wanted = signals.kept[n] + period;
      const auto later = std::ranges::lower_bound(signals.kept, wanted - std::min(wanted, stride / 2));
      if (later == signals.kept.end() || *later > wanted + stride / 2) continue;
      const double here = residual(static_cast<Eigen::Index>(signals.first_row + n));
      const double there = residual(
          static_cast<Eigen::Index>(signals.first_row + static_cast<std::size_t>(later - signals.kept.begin())));
      squares += 0.5 * (here * here + there * there);
      differences += 0.5 * (here - there) * (here - there);
      seconds += static_cast<double>(stride) * signals.period_s;
    }
  }
  if (seconds < kLeastSeconds || !(squares > 0.0)) return {};
  const double count = static_cast<double>(residual.size());
  Repeatability found;
  found.share = std::clamp(1.0 - differences / squares, 0.0, 1.0);
  found.floor = std::sqrt(residual.squaredNorm() / count * (1.0 - found.share));
  found.seconds = seconds;
  return found;
}

}  // namespace host
