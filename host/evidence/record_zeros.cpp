#include "host/evidence/record_zeros.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>

#include "host/dense_solutions.hpp"
#include "host/evidence/channel_shift.hpp"
#include "host/evidence/period_search.hpp"

namespace host {

namespace {

using Amplitude = std::complex<double>;

/// Least part of a rigid model's residual that a period must explain in both records: the strongest one, and each
/// further one.
constexpr double kStrong = 0.1, kFurther = 0.03;
/// The amplitudes of two records must agree within this factor, and the halves of a record within this part of the
/// amplitude. Only a pattern that is fixed to the travel does so, even if it is a small part of the residual.
constexpr double kAlikeFriction = 1.5, kSteady = 0.5;
/// Correlation of two patterns at the best shift. If it is below kDiffers without a shift (45 degrees of phase), the
/// zeros certainly differ. If another zero is known to be lost, below kSame (15 degrees) suffices.
constexpr double kAgrees = 0.9, kDiffers = 0.7, kSame = 0.97;
/// Largest uncertainty of a phase, as a part of the period.
constexpr double kMostOpen = 0.1;
/// A period that explains less than this part of the share of the strongest period is ignored.
constexpr double kAsGood = 0.8;
constexpr double kPeriodsOfTravel = 4.0;
constexpr std::size_t kPeaks = 5;
/// More rows than this take time without adding information.
constexpr std::size_t kMostSpeeds = 3000;

/// The pattern is constant in size (cogging), or proportional to the direction (friction) or to the torque (torque
/// ripple).
constexpr std::size_t kWeights = 3;

struct TravelResidual {
  std::vector<double> x, left;
  std::array<std::vector<double>, kWeights> weight;
  std::array<std::vector<PeriodPeak>, kWeights> peaks;
  double middle = 0.0, travel = 0.0;     ///< middle and range of x, mm or m
  double size = 0.0;                     ///< norm of `left`, Nm or N
  double shortest = 0.0, longest = 0.0;  ///< candidate periods of the record, mm or m

  TravelSignal signal(std::size_t w, std::size_t begin, std::size_t end) const {
    const auto part = [&](const std::vector<double>& values) {
      return std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(begin),
                                 values.begin() + static_cast<std::ptrdiff_t>(end));
    };
    return {part(x), part(left), part(weight[w])};
  }
  TravelSignal signal(std::size_t w) const { return signal(w, 0, x.size()); }
};

/// Residual of inertia and friction fitted to this record alone, while the axis slides.
std::optional<TravelResidual> travel_residual(const Record& record, const sim::DataSheet& data, bool by_speed) {
  constexpr double kSlow = 0.01, kHighest_Hz = 100.0, kRateShare = 0.1;
  constexpr std::size_t kFewestRows = 300;
  MotionOptions options;
  options.by_speed = by_speed;
  options.cutoff_Hz = std::min(kHighest_Hz, kRateShare / record.sample_period_s);
  options.decimation = 1;
  double top = 0.0;
  for (const double w : smooth_speed(record, data, *options.cutoff_Hz, by_speed)) top = std::max(top, std::abs(w));
  options.deadband = kSlow * top;
  if (!(top > 0.0)) return {};
  const std::optional<Motion> motion = motion_if_long_enough(record, data, options);
  if (!motion) return {};
  const std::size_t stride = 1 + motion->speed.size() / kMostSpeeds;
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < motion->speed.size(); k += stride)
    if (motion->counts[k]) rows.push_back(k);
  if (rows.size() < kFewestRows) return {};
  const auto count = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd phi(count, 4);
  Eigen::VectorXd effort(count);
  TravelResidual residual;
  double speeds = 0.0;
  for (Eigen::Index n = 0; n < count; ++n) {
    const std::size_t k = rows[static_cast<std::size_t>(n)];
    const double w = motion->speed[k];
    phi.row(n) << motion->acceleration[k], w, w > 0.0 ? 1.0 : 0.0, w > 0.0 ? 0.0 : 1.0;
    effort(n) = motion->effort[k];
    residual.x.push_back(motion->travel[k]);
    residual.weight[0].push_back(1.0);
    residual.weight[1].push_back(w > 0.0 ? 1.0 : -1.0);
    residual.weight[2].push_back(motion->effort[k]);
    speeds += std::abs(w);
  }
  const Eigen::VectorXd left = effort - phi * least_norm_solution(phi, effort);
  residual.left.assign(left.begin(), left.end());
  residual.size = left.norm();
  const auto [low, high] = std::ranges::minmax(residual.x);
  residual.middle = 0.5 * (low + high);
  residual.travel = high - low;
  residual.longest = residual.travel / kPeriodsOfTravel;
  residual.shortest = data.lead * speeds / static_cast<double>(rows.size()) / *options.cutoff_Hz;
  return residual;
}

/// Uses the channel whose motion leaves the smaller residual.
std::optional<TravelResidual> travel_residual(const Record& record, const sim::DataSheet& data) {
  if (!record.has_position()) return {};
  std::optional<TravelResidual> residual = travel_residual(record, data, false);
  if (residual && record.has_speed()) {
    std::optional<TravelResidual> by_speed = travel_residual(record, data, true);
    if (by_speed && by_speed->size < residual->size) residual = std::move(by_speed);
  }
  for (std::size_t w = 0; residual && w < kWeights; ++w)
    residual->peaks[w] = find_periods(residual->signal(w), residual->shortest, residual->longest, kPeaks);
  return residual;
}

Amplitude amplitude_of(const PeriodPeak& peak) { return {peak.cosine, -peak.sine}; }

/// Amplitudes at the periods that two records share.
struct Pattern {
  std::vector<double> period;
  std::vector<Amplitude> amplitude;

  void add(double of_period, const Amplitude& value) {
    period.push_back(of_period);
    amplitude.push_back(value);
  }
  double size() const {
    double square = 0.0;
    for (const Amplitude& value : amplitude) square += std::norm(value);
    return std::sqrt(square);
  }
};

/// Correlation of two patterns if the travel of the second one is shifted, -1 to 1.
double agreement(const Pattern& a, const Pattern& b, double shift) {
  double sum = 0.0;
  for (std::size_t n = 0; n < a.amplitude.size(); ++n)
    sum += (a.amplitude[n] * std::conj(b.amplitude[n] * std::polar(1.0, -2.0 * std::numbers::pi * shift / a.period[n])))
               .real();
  return sum / std::max(a.size() * b.size(), 1e-300);
}

/// Whether a period has the same phase and amplitude in both halves of a record.
bool is_steady(const TravelResidual& residual, std::size_t weight, double period) {
  const std::size_t half = residual.x.size() / 2;
  const Amplitude first = amplitude_of(peak_at(residual.signal(weight, 0, half), period));
  const Amplitude second = amplitude_of(peak_at(residual.signal(weight, half, residual.x.size()), period));
  return std::abs(first - second) < kSteady * std::min(std::abs(first), std::abs(second));
}

/// Periods that both records show with equal amplitude, with the same kind of weight.
struct SharedPattern {
  Pattern here, there;
  double share = 0.0;  ///< share of the strongest period, the smaller one of the two records
};

SharedPattern shared_pattern(const TravelResidual& first, const TravelResidual& second, std::size_t weight) {
  SharedPattern shared;
  const TravelSignal signals[] = {first.signal(weight), second.signal(weight)};
  const double apart =
      std::max(std::abs(first.middle - second.middle), kMostOpen * std::min(first.travel, second.travel));
  for (const PeriodPeak& peak : first.peaks[weight]) {
    const auto off = [&](const PeriodPeak& other) { return std::abs(1.0 / other.period - 1.0 / peak.period); };
    const auto same = std::ranges::min_element(second.peaks[weight], {}, off);
    // The uncertainty of the period gives the uncertainty of its phase at the other record's travel. It follows from
    // the difference between the periods of the two records.
    if (same == second.peaks[weight].end() || off(*same) * apart > kMostOpen) continue;
    const double period = first.travel > second.travel ? peak.period : same->period;
    const PeriodPeak here = peak_at(signals[0], period), there = peak_at(signals[1], period);
    const Amplitude a = amplitude_of(here), b = amplitude_of(there);
    const double share = std::min(here.share, there.share);
    const bool alike = std::max(std::abs(a), std::abs(b)) < kAlikeFriction * std::min(std::abs(a), std::abs(b));
    if (share < (shared.here.period.empty() ? kStrong : kFurther) || !alike) continue;
    if (!is_steady(first, weight, period) || !is_steady(second, weight, period)) continue;
    shared.share = std::max(shared.share, share);
    shared.here.add(period, a);
    shared.there.add(period, b);
  }
  return shared;
}

/// Share of the strongest period that has the same phase and amplitude throughout a record.
double steady_share(const TravelResidual& residual) {
  double best = 0.0;
  for (std::size_t w = 0; w < kWeights; ++w)
    for (const PeriodPeak& peak : residual.peaks[w])
      if (peak.share > best && is_steady(residual, w, peak.period)) best = peak.share;
  return best;
}

struct Alignment {
  AnotherZero zero;
  double as_it_is;  ///< agreement without a shift
};

std::optional<Alignment> alignment(const TravelResidual& first, const TravelResidual& second) {
  std::vector<SharedPattern> patterns;
  for (std::size_t w = 0; w < kWeights; ++w) patterns.push_back(shared_pattern(first, second, w));
  const SharedPattern& strongest = *std::ranges::max_element(patterns, {}, &SharedPattern::share);
  if (strongest.here.period.empty()) return {};
  double as_it_is = -1.0;
  for (const SharedPattern& pattern : patterns)
    if (pattern.share > kAsGood * strongest.share)
      as_it_is = std::max(as_it_is, agreement(pattern.here, pattern.there, 0.0));
  const std::vector<double>& periods = strongest.here.period;
  AnotherZero other{.period = *std::ranges::max_element(periods)};
  double best = -1.0;
  const double shortest = *std::ranges::min_element(periods);
  const int steps = static_cast<int>(std::ceil(100.0 * other.period / shortest));
  for (int step = -steps / 2; step <= steps / 2; ++step) {
    const double shift = other.period * step / steps, alike = agreement(strongest.here, strongest.there, shift);
    if (alike <= best) continue;
    best = alike;
    other.shift = shift;
  }
  if (best < kAgrees) return {};
  return Alignment{other, as_it_is};
}

}  // namespace

std::vector<AnotherZero> other_zeros(const std::vector<const Record*>& records, const sim::DataSheet& data) {
  if (records.size() < 2) return {};
  std::vector<std::optional<TravelResidual>> residuals;
  std::size_t reference = 0;
  double strongest = 0.0;
  for (const Record* record : records) {
    residuals.push_back(travel_residual(*record, data));
    const double share = residuals.back() ? steady_share(*residuals.back()) : 0.0;
    if (share <= strongest) continue;
    strongest = share;
    reference = residuals.size() - 1;
  }
  if (strongest < kStrong) return {};
  std::vector<Alignment> alignments;
  for (std::size_t r = 0; r < residuals.size(); ++r) {
    if (r == reference || !residuals[r]) continue;
    std::optional<Alignment> found = alignment(*residuals[reference], *residuals[r]);
    if (!found) continue;
    found->zero.record = r;
    found->zero.reference = reference;
    alignments.push_back(*found);
  }
  const auto is_lost = [](const Alignment& one) { return one.as_it_is < kDiffers; };
  std::vector<AnotherZero> lost;
  if (std::ranges::none_of(alignments, is_lost)) return lost;
  for (const Alignment& one : alignments)
    if (one.as_it_is < kSame) lost.push_back(one.zero);
  return lost;
}

}  // namespace host
