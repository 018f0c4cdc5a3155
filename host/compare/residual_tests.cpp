#include "host/compare/residual_tests.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <numeric>
#include <span>

#include "host/evidence/period_search.hpp"
#include "host/fourier.hpp"
#include "host/known_by_current.hpp"
#include "host/report/text_format.hpp"
#include "host/statistics.hpp"

namespace host {

namespace {

using Values = std::vector<double>;

/// Fewest samples in a set for a test.
constexpr std::size_t kFewestTested = 100;

/// Samples are clipped at this multiple of the median magnitude, so that one breakaway does not hide recurring effects.
constexpr double kMostMedians = 6.0;

Values clipped(Values values) {
  Values sizes(values.size());
  std::ranges::transform(values, sizes.begin(), [](double value) { return std::abs(value); });
  const double most = kMostMedians * median(std::move(sizes));
  for (double& value : values) value = std::clamp(value, -most, most);
  return values;
}

double sum_of_squares(const Values& values) {
  return std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
}

/// A curve of means over bins with equal numbers of samples. The mean of a few samples is shrunk towards zero.
class Curve {
 public:
  Curve(const Values& coordinate, const Values& value, std::size_t bins) {
    constexpr double kDrawnBy = 10.0;  // samples; neighbours are correlated, so ten are worth about one
    Values sorted = coordinate;
    std::ranges::sort(sorted);
    for (std::size_t bin = 1; bin < bins; ++bin) edges_.push_back(sorted[bin * sorted.size() / bins]);
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
    low_ = sorted.front();
    high_ = sorted.back();
    Values sums(edges_.size() + 1), counts(edges_.size() + 1);
    for (std::size_t k = 0; k < value.size(); ++k) {
      sums[bin_of(coordinate[k])] += value[k];
      ++counts[bin_of(coordinate[k])];
    }
    for (std::size_t bin = 0; bin < sums.size(); ++bin) means_.push_back(sums[bin] / (counts[bin] + kDrawnBy));
    for (std::size_t bin = 0; bin < sums.size(); ++bin) weights_.push_back(counts[bin] * means_[bin] * means_[bin]);
  }

  double operator()(double coordinate) const { return means_[bin_of(coordinate)]; }

  /// The range of bins around the strongest one that have its sign and at least half of its height.
  std::pair<double, double> stands_out() const {
    const auto top = static_cast<std::size_t>(std::ranges::max_element(weights_) - weights_.begin());
    const auto alike = [&](std::size_t bin) { return means_[bin] / means_[top] > 0.5; };
    std::size_t from = top, to = top;
    while (from > 0 && alike(from - 1)) --from;
    while (to + 1 < means_.size() && alike(to + 1)) ++to;
    return {from == 0 ? low_ : edges_[from - 1], to == edges_.size() ? high_ : edges_[to]};
  }

 private:
  std::size_t bin_of(double coordinate) const {
    return static_cast<std::size_t>(std::ranges::upper_bound(edges_, coordinate) - edges_.begin());
  }
  Values edges_, means_, weights_;
  double low_ = 0.0, high_ = 0.0;
};

/// The residual of a set, prepared for the tests.
struct Half {
  ResidualEffort samples;
  Values value;

  explicit Half(ResidualEffort residual) : samples(std::move(residual)), value(clipped(samples.missing)) {}

  /// The residual as friction, positive if it opposes the motion.
  Half resisting() const {
    Half half = *this;
    for (std::size_t k = 0; k < half.value.size(); ++k)
      if (samples.w[k] < 0.0) half.value[k] = -half.value[k];
    return half;
  }
};

/// Both sets along one coordinate, split in blocks into two folds. A curve fitted on one fold is validated on the
/// other. The sets themselves are no suitable folds, because one of them may not reach the position of an effect.
struct Folds {
  std::array<Values, 2> along, value;

  template <typename Coordinate>
  Folds(const std::array<const Half*, 2>& halves, Coordinate coordinate) {
    constexpr std::size_t kBlock = 10;  // windows
    for (const Half* half : halves) {
      const Values& values = std::invoke(coordinate, half->samples);
      for (std::size_t k = 0; k < values.size(); ++k) {
        const std::size_t fold = (half->samples.window[k] / kBlock) % 2;
        along[fold].push_back(values[k]);
        value[fold].push_back(half->value[k]);
      }
    }
  }

  double removed_share(std::size_t bins) const {
    double left = 0.0, all = 0.0;
    for (const std::size_t tried : {0U, 1U}) {
      const std::size_t other = 1 - tried;
      if (along[other].empty()) return 0.0;
      const Curve learnt(along[other], value[other], bins);
      for (std::size_t k = 0; k < value[tried].size(); ++k)
        left += std::pow(value[tried][k] - learnt(along[tried][k]), 2);
      all += sum_of_squares(value[tried]);
    }
    return all > 0.0 ? std::max(0.0, 1.0 - left / all) : 0.0;
  }
};

/// The strongest ripple over the travel, fitted on one fold and validated on the other. Bins over the whole travel are
/// too wide for effects that repeat with each turn of a screw.
ResidualDependence on_period(const std::array<const Half*, 2>& halves, double resolution, double in_mm) {
  constexpr double kStepsAPeriod = 40.0, kFinest = 2000.0, kPeriodsOfTravel = 3.0;
  ResidualDependence result{"position", {}, 0.0};
  const Folds folds(halves, &ResidualEffort::x);
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const Values& along : folds.along)
    for (const double x : along) low = std::min(low, x), high = std::max(high, x);
  const double shortest = std::max(kStepsAPeriod * resolution, (high - low) / kFinest);
  const double longest = (high - low) / kPeriodsOfTravel;
  if (!(longest > shortest)) return result;
  const auto strongest = [&](const Values& along, const Values& value) {
    return find_periods({along, value, Values(along.size(), 1.0)}, shortest, longest, 1);
  };
  double left = 0.0, all = 0.0;
  for (const std::size_t tried : {0U, 1U}) {
    const std::size_t other = 1 - tried;
    const std::vector<PeriodPeak> peaks = strongest(folds.along[other], folds.value[other]);
    if (peaks.empty()) return result;
    const PeriodPeak& peak = peaks.front();
    for (std::size_t k = 0; k < folds.value[tried].size(); ++k) {
      const double turn = 2.0 * std::numbers::pi * folds.along[tried][k] / peak.period;
      left += std::pow(folds.value[tried][k] - peak.cosine * std::cos(turn) - peak.sine * std::sin(turn), 2);
    }
    all += sum_of_squares(folds.value[tried]);
  }
  const std::vector<PeriodPeak> peaks = strongest(halves[0]->samples.x, halves[0]->value);
  if (peaks.empty()) return result;
  result.where = fmt::format("every {} mm of travel", format_value(in_mm * peaks.front().period, 4));
  result.share = all > 0.0 ? std::max(0.0, 1.0 - left / all) : 0.0;
  return result;
}

/// Part of the squared residual in a window that the windows before and after it predict.
double share_of_time(const Half& half) {
  const std::vector<std::size_t>& window = half.samples.window;
  const std::size_t windows = window.back() + 1;
  Values sums(windows), counts(windows);
  for (std::size_t k = 0; k < window.size(); ++k) {
    sums[window[k]] += half.value[k];
    ++counts[window[k]];
  }
  double product = 0.0, square = 0.0;  // of a window's mean and the mean of its neighbours
  Values foretold(windows);
  for (std::size_t k = 1; k + 1 < windows; ++k) {
    const double count = counts[k - 1] + counts[k + 1];
    if (count <= 0.0 || counts[k] <= 0.0) continue;
    foretold[k] = (sums[k - 1] + sums[k + 1]) / count;
    product += foretold[k] * sums[k];
    square += foretold[k] * foretold[k] * counts[k];
  }
  // The best multiple of the neighbours' mean reduces the squared error by product^2/square.
  return product > 0.0 && square > 0.0 ? product * product / square / sum_of_squares(half.value) : 0.0;
}

/// Power over frequency, averaged over segments of 2 s with half overlap (Welch 1967, Hann window), 0.5 Hz apart.
struct Spectrum {
  static constexpr double kSegment_s = 2.0, kLowest_Hz = 3.0;
  Values power;  ///< power of line k, at k/kSegment_s Hz; the sum is about 1

  explicit Spectrum(const Half& half) {
    const double period_s = half.samples.period_s;
    const auto length = static_cast<std::size_t>(std::lround(kSegment_s / period_s));
    power.assign(length / 2, 0.0);
    const Values window = hann_window(length);
    Values series;
    for (std::size_t k = 0; k < half.value.size();) {
      const std::size_t record = half.samples.record[k], first = half.samples.slot[k];
      series.clear();
      for (; k < half.value.size() && half.samples.record[k] == record; ++k) {
        series.resize(half.samples.slot[k] - first + 1, 0.0);
        series.back() = half.value[k];
      }
      for (std::size_t begin = 0; begin + length <= series.size(); begin += length / 2)
        add(std::span(series).subspan(begin, length), window);
    }
    const double total = std::accumulate(power.begin(), power.end(), 0.0);
    if (total > 0.0)
      for (double& line : power) line /= total;
  }

  /// Power of a line and its two neighbours above the median of the lines around them, as a share of the total.
  double outstanding(std::size_t line) const {
    constexpr std::size_t kRound = 12;
    if (line < static_cast<std::size_t>(kLowest_Hz * kSegment_s) || line + 1 >= power.size()) return 0.0;
    Values round;
    for (std::size_t k = line - std::min(line, kRound); k < std::min(power.size(), line + kRound + 1); ++k)
      if (k + 1 < line || k > line + 1) round.push_back(power[k]);
    return power[line - 1] + power[line] + power[line + 1] - 3.0 * median(std::move(round));
  }

  std::size_t strongest() const {
    std::size_t best = 0;
    for (std::size_t line = 0; line < power.size(); ++line)
      if (outstanding(line) > outstanding(best)) best = line;
    return best;
  }

 private:
  void add(std::span<const double> values, const Values& window) {
    Values windowed(values.size());
    std::ranges::transform(values, window, windowed.begin(), std::multiplies<>());
    const std::vector<std::complex<double>> lines = spectrum_of(windowed);
    for (std::size_t line = 0; line < power.size(); ++line) power[line] += std::norm(lines[line]);
  }
};

ResidualDependence on_frequency(const Half& training, const Half& validation) {
  const Spectrum first(training), second(validation);
  ResidualDependence best{"frequency", {}, 0.0};
  for (const std::size_t line : {first.strongest(), second.strongest()}) {
    const double share = std::min(first.outstanding(line), second.outstanding(line));
    if (share <= best.share) continue;
    best.share = share;
    best.where = fmt::format("at {:.1f} Hz", static_cast<double>(line) / Spectrum::kSegment_s);
  }
  return best;
}

Correlation correlation(const ResidualEffort& samples, const Values& value, const Values& other, long from, long to) {
  Correlation result;
  const auto centred = [](Values values) {
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    for (double& entry : values) entry -= mean;
    return values;
  };
  const Values a = centred(value), b = centred(other);
  const double scale = std::sqrt(sum_of_squares(a) * sum_of_squares(b));
  constexpr double kNormal99 = 2.576;
  result.bound = kNormal99 / std::sqrt(static_cast<double>(a.size()));
  for (long lag = from; lag <= to; ++lag) {
    double sum = 0.0;
    for (long k = std::max(0L, lag), n = static_cast<long>(a.size()); k < std::min(n, n + lag); ++k) {
      const auto now = static_cast<std::size_t>(k), then = static_cast<std::size_t>(k - lag);
      const bool evenly = samples.record[now] == samples.record[then] &&
                          static_cast<long>(samples.slot[now]) - static_cast<long>(samples.slot[then]) == lag;
      if (evenly) sum += a[now] * b[then];
    }
    result.lag_s.push_back(static_cast<double>(lag) * samples.period_s);
    result.value.push_back(scale > 0.0 ? sum / scale : 0.0);
  }
  return result;
}

/// Speeds in separate ranges for each duration of the preceding rest, because friction that has grown at rest decays
/// with speed.
Values speed_after_rests(const ResidualEffort& samples) {
  constexpr std::array kEdges_s{0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 3.2};
  const double apart = 3.0 * std::ranges::max(samples.w, {}, [](double w) { return std::abs(w); });
  Values result = samples.w;
  for (std::size_t k = 0; k < result.size(); ++k)
    result[k] += apart * static_cast<double>(std::ranges::upper_bound(kEdges_s, samples.rest_s[k]) - kEdges_s.begin());
  return result;
}

/// Time through all records in sequence.
Values time_in_all(const ResidualEffort& samples) {
  Values result = samples.t_s;
  double before = 0.0, longest = 0.0;
  for (std::size_t k = 0; k < result.size(); ++k) {
    if (k > 0 && samples.record[k] != samples.record[k - 1]) {
      before += longest;
      longest = 0.0;
    }
    longest = std::max(longest, samples.t_s[k]);
    result[k] += before;
  }
  return result;
}

void look_near_reversals(const std::array<const ResidualEffort*, 2>& sets, const sim::DataSheet& data,
                         ResidualTests& tests) {
  constexpr double kNearest = 0.25;  // of the samples
  Values travelled;
  double all = 0.0, near = 0.0;
  for (const ResidualEffort* samples : sets)
    for (const double travel : samples->since_reversal) travelled.push_back(std::abs(travel));
  if (travelled.size() < kFewestTested) return;
  const auto edge = travelled.begin() + static_cast<long>(kNearest * static_cast<double>(travelled.size()));
  std::ranges::nth_element(travelled, edge);
  for (const ResidualEffort* samples : sets)
    for (std::size_t k = 0; k < samples->missing.size(); ++k) {
      const double square = samples->missing[k] * samples->missing[k];
      all += square;
      if (std::abs(samples->since_reversal[k]) <= *edge) near += square;
    }
  tests.near_reversals = all > 0.0 ? near / all : 0.0;
  tests.where_near_reversals = fmt::format("within {} mm of a reversal",
                                           format_value((data.kind == sim::DriveKind::rotary ? 1.0 : 1e3) * *edge, 2));
}

ResidualTests test(const Half& first, const Half& second, const sim::DataSheet& data, bool has_position) {
  ResidualTests tests;
  if (std::min(first.value.size(), second.value.size()) < kFewestTested) return tests;
  if (!(sum_of_squares(first.value) > 0.0) || !(sum_of_squares(second.value) > 0.0)) return tests;
  tests.rms = std::sqrt(sum_of_squares(second.value) / static_cast<double>(second.value.size()));

  const bool rotary = data.kind == sim::DriveKind::rotary;
  const std::array as_friction{first.resisting(), second.resisting()};
  const auto against = [&](const char* coordinate, Values ResidualEffort::*along, std::size_t bins, double factor,
                           const char* words, const char* unit) {
    if ((first.samples.*along).size() != first.value.size() || (second.samples.*along).size() != second.value.size())
      return;
    ResidualDependence dependence{coordinate, {}, -1.0};
    for (const auto& halves : {std::array{&first, &second}, std::array{&as_friction[0], &as_friction[1]}}) {
      const double share = Folds(halves, along).removed_share(bins);
      if (share <= dependence.share) continue;
      dependence.share = share;
      Values all_along = first.samples.*along, all = halves[0]->value;
      all_along.insert(all_along.end(), (second.samples.*along).begin(), (second.samples.*along).end());
      all.insert(all.end(), halves[1]->value.begin(), halves[1]->value.end());
      const auto [from, to] = Curve(all_along, all, bins).stands_out();
      const std::string least = format_value(factor * from, 3), most = format_value(factor * to, 3);
      dependence.where = least == most ? fmt::format("{} of {} {}", words, least, unit)
                                       : fmt::format("{} between {} and {} {}", words, least, most, unit);
    }
    tests.dependences.push_back(std::move(dependence));
  };
  const double in_mm = rotary ? 1.0 : 1e3;
  const char* speed_unit = rotary ? "rad/s" : "m/s";
  against("speed", &ResidualEffort::w, 24, 1.0, "at speeds", speed_unit);
  if (has_position) {
    against("position", &ResidualEffort::x, 40, in_mm, "at positions", "mm");
    for (const auto& halves : {std::array{&first, &second}, std::array{&as_friction[0], &as_friction[1]}})
      if (ResidualDependence periodic = on_period(halves, data.encoder_resolution, in_mm);
          !tests.dependences.empty() && tests.dependences.back().coordinate == "position" &&
          periodic.share > tests.dependences.back().share)
        tests.dependences.back() = std::move(periodic);
  }
  against("travel_since_reversal", &ResidualEffort::since_reversal, 24, in_mm, "where the travel since a reversal is",
          "mm");
  against("acceleration", &ResidualEffort::acceleration, 24, 1.0, "at accelerations", rotary ? "rad/s²" : "m/s²");
  const bool by_current = is_known_by_current(data);  // then the command is in amperes
  against("current", &ResidualEffort::command_V, 24, 1.0, by_current ? "at currents" : "at commands",
          by_current ? "A" : "V");
  against("rest", &ResidualEffort::rest_s, 12, 1.0, "after a rest", "s");
  against("temperature", &ResidualEffort::temp_C, 12, 1.0, "at temperatures", "°C");
  tests.dependences.push_back(
      {"time", "from one moment to the next", std::max(share_of_time(first), share_of_time(second))});
  tests.dependences.push_back(on_frequency(first, second));
  const auto in_detail = [&](const char* coordinate, auto along, std::size_t bins) {
    const auto known = std::ranges::find(tests.dependences, coordinate, &ResidualDependence::coordinate);
    for (const auto& halves : {std::array{&first, &second}, std::array{&as_friction[0], &as_friction[1]}})
      known->in_detail = std::max(known->in_detail, Folds(halves, along).removed_share(bins));
  };
  constexpr std::size_t kFine = 100, kSlow = 40;
  in_detail("rest", speed_after_rests, kFine);
  in_detail("travel_since_reversal", &ResidualEffort::since_reversal, kFine);
  in_detail("time", time_in_all, kSlow);
  for (const auto& halves : {std::array{&first, &second}, std::array{&as_friction[0], &as_friction[1]}})
    tests.constant = std::max(tests.constant, Folds(halves, &ResidualEffort::w).removed_share(1));
  std::ranges::stable_sort(tests.dependences, std::greater(), &ResidualDependence::share);

  constexpr long kLags = 20;  // of 5 ms, together the length of a window
  tests.with_itself = correlation(second.samples, second.value, second.value, 0, kLags);
  tests.with_command = correlation(second.samples, second.value, second.samples.command_V, -kLags, kLags);
  return tests;
}

}  // namespace

ResidualTests test_residuals(const sim::DriveDescription& model, const RecordSet& training,
                             const RecordSet& validation) {
  const bool has_position = training.records.front().prepared.record->has_position();
  const Half first(residual_effort(model, training)), second(residual_effort(model, validation));
  ResidualTests tests = test(first, second, model.data, has_position);
  if (has_position) look_near_reversals({&first.samples, &second.samples}, model.data, tests);
  return tests;
}

ResidualTests test_speed_channel(const sim::DriveDescription& model, const RecordSet& training,
                                 const RecordSet& validation) {
  return test(Half(residual_of_speed_channel(model, training)), Half(residual_of_speed_channel(model, validation)),
              model.data, true);
}

}  // namespace host
