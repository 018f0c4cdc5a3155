#include "host/response/loop_margins.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "host/exit_codes.hpp"
#include "host/statistics.hpp"

namespace host {

namespace {

using Complex = std::complex<double>;

constexpr std::size_t kFinePoints = 600;
constexpr int kPerResonance = 41;  ///< further points within five half widths on both sides
constexpr std::size_t kNearest = 5;
constexpr int kRepetitions = 200;
constexpr double kMarginDegrees = 180.0 / std::numbers::pi;

/// Local linear smoother: fits a straight line over log f to the nearest measured lines. Holds their weights.
struct Smoother {
  std::size_t first = 0;
  std::vector<double> weight;
};

Smoother smoother_at(double f, const std::vector<double>& lines, const std::vector<double>& spread) {
  const std::size_t count = std::min(kNearest, lines.size());
  Smoother found;
  while (found.first + count < lines.size() &&
         std::abs(std::log(lines[found.first + count] / f)) < std::abs(std::log(lines[found.first] / f)))
    ++found.first;
  double reach = 0.0;
  for (std::size_t i = 0; i < count; ++i) reach = std::max(reach, std::abs(std::log(lines[found.first + i] / f)));
  reach = 1.2 * reach + 1e-9;
  double s0 = 0.0, s1 = 0.0, s2 = 0.0;
  std::vector<double> at(count), near(count);
  for (std::size_t i = 0; i < count; ++i) {
    at[i] = std::log(lines[found.first + i] / f);
    const double part = std::abs(at[i]) / reach;
    near[i] = std::pow(1.0 - part * part * part, 3) / (spread[found.first + i] * spread[found.first + i]);
    s0 += near[i];
    s1 += near[i] * at[i];
    s2 += near[i] * at[i] * at[i];
  }
  const double determinant = s0 * s2 - s1 * s1;
  for (std::size_t i = 0; i < count; ++i)
    found.weight.push_back(determinant > 1e-12 * s0 * s2 ? near[i] * (s2 - s1 * at[i]) / determinant : near[i] / s0);
  return found;
}

/// Indices of the significant lines; all lines if these are too few for a straight line.
std::vector<std::size_t> places_of(const std::vector<bool>& stands_out) {
  std::vector<std::size_t> places, all;
  for (std::size_t i = 0; i < stands_out.size(); ++i) {
    all.push_back(i);
    if (stands_out[i]) places.push_back(i);
  }
  return places.size() < kNearest ? all : places;
}

template <typename Value>
std::vector<Value> picked(const std::vector<Value>& all, const std::vector<std::size_t>& places) {
  std::vector<Value> some;
  for (const std::size_t place : places) some.push_back(all[place]);
  return some;
}

/// From the first to the last line, equally spaced in log f, denser near resonances.
std::vector<double> fine_frequencies(const std::vector<double>& lines, const PlantFit& fit) {
  const double low = std::log(lines.front()), high = std::log(lines.back());
  std::vector<double> f;
  for (std::size_t i = 0; i < kFinePoints; ++i)
    f.push_back(std::exp(low + (high - low) * static_cast<double>(i) / static_cast<double>(kFinePoints - 1)));
  for (const Resonance& mode : fit.resonances)
    for (int i = 0; i < kPerResonance; ++i) {
      const double away = 5.0 * (2.0 * i / (kPerResonance - 1.0) - 1.0);
      const double at = mode.f_Hz.value * (1.0 + away * mode.damping.value);
      if (at > lines.front() && at < lines.back()) f.push_back(at);
    }
  std::ranges::sort(f);
  return f;
}

/// Values that are the same in each repetition.
class FineLoop {
 public:
  FineLoop(const FrequencyResponse& response, const PlantFit& fit, const AxisController& controller) {
    if (std::abs(response.sample_period_s - controller.sample_period_s()) > 1e-4 * controller.sample_period_s())
      throw Failure(ExitCode::bad_input,
                    fmt::format("the response was sampled every {:g} s, but the controller runs every {:g} s",
                                response.sample_period_s, controller.sample_period_s()));
    if (!response.has_position || (controller.uses_speed() && !response.has_speed))
      throw Failure(ExitCode::bad_input,
                    "the controller uses a channel that the records lack: record position, and speed where a "
                    "tachometer is fitted");
    std::vector<bool> clear;
    for (const ResponseLine& line : response.lines) {
      const Eigen::RowVector2cd C = controller.at(line.f_Hz);
      clear.push_back(stands_out(line, C.transpose()));
      const Complex L = (C * line.plant)(0), fitted = (C * fit.at(line.f_Hz))(0);
      loop_.f_Hz.push_back(line.f_Hz);
      loop_.L.push_back(L);
      loop_.half_width.push_back(half_width_95(line, C.transpose()));
      ratio_.push_back(L / fitted);
      spread_.push_back(loop_.half_width.back() / (kNormal95 * std::abs(fitted)) + 1e-6);
    }
    const std::vector<std::size_t> places = places_of(clear);
    ratio_ = picked(ratio_, places);
    spread_ = picked(spread_, places);
    const std::vector<double> lines = picked(loop_.f_Hz, places);
    loop_.fine_f_Hz = fine_frequencies(lines, fit);
    for (const double f : loop_.fine_f_Hz) {
      carrier_.push_back((controller.at(f) * fit.at(f))(0));
      smoothers_.push_back(smoother_at(f, lines, spread_));
    }
    loop_.fine_L = along(ratio_);
  }

  const OpenLoop& loop() const { return loop_; }

  std::vector<Complex> repetition(std::mt19937& random) const {
    std::normal_distribution<double> normal;
    std::vector<Complex> ratio = ratio_;
    for (std::size_t i = 0; i < ratio.size(); ++i) ratio[i] += spread_[i] * Complex(normal(random), normal(random));
    return along(ratio);
  }

 private:
  std::vector<Complex> along(const std::vector<Complex>& ratio) const {
    std::vector<Complex> L(carrier_.size());
    for (std::size_t i = 0; i < L.size(); ++i) {
      Complex sum = 0.0;
      for (std::size_t k = 0; k < smoothers_[i].weight.size(); ++k)
        sum += smoothers_[i].weight[k] * ratio[smoothers_[i].first + k];
      L[i] = carrier_[i] * sum;
    }
    return L;
  }

  OpenLoop loop_;
  std::vector<Complex> ratio_, carrier_;
  std::vector<double> spread_;
  std::vector<Smoother> smoothers_;
};

/// Margins; NaN for a margin that does not exist.
struct Values {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  bool is_stable = true;
  double gain_dB = kNone, phase_deg = kNone, modulus = kNone, crossover_Hz = kNone, modulus_at_Hz = 0.0;
};

/// Nyquist: the phase of 1 + L goes from its start at the integrators (between -360 and 0 degrees) to 0, without a
/// further encirclement of the origin. Neither the controllers of AxisController nor drives have unstable poles.
bool is_stable(const std::vector<Complex>& L) {
  double turned = 0.0;
  for (std::size_t i = 1; i < L.size(); ++i) turned += std::arg((1.0 + L[i]) / (1.0 + L[i - 1]));
  const double start =
      std::arg(1.0 + L.front()) > 0.0 ? std::arg(1.0 + L.front()) - 2.0 * std::numbers::pi : std::arg(1.0 + L.front());
  const double rest = std::arg(1.0 + L.back());
  return std::abs(turned + start - rest) < std::numbers::pi;
}

Values values_of(const std::vector<double>& f, const std::vector<Complex>& L) {
  Values found;
  found.is_stable = is_stable(L);
  const double sign = found.is_stable ? 1.0 : -1.0;
  for (std::size_t i = 0; i < L.size(); ++i) {
    const double distance = std::abs(1.0 + L[i]);
    if (!(distance >= found.modulus)) {
      found.modulus = distance;
      found.modulus_at_Hz = f[i];
    }
    if (i == 0) continue;
    const double before = std::log(std::abs(L[i - 1])), now = std::log(std::abs(L[i]));
    if ((before > 0.0) != (now > 0.0)) {
      const double part = before / (before - now);
      const double margin =
          (std::numbers::pi - std::abs(std::arg(L[i - 1] + part * (L[i] - L[i - 1])))) * kMarginDegrees;
      if (!(margin >= std::abs(found.phase_deg))) found.phase_deg = sign * margin;
      if (before > 0.0 && std::isnan(found.crossover_Hz))
        found.crossover_Hz = f[i - 1] * std::pow(f[i] / f[i - 1], part);
    }
    const double below = L[i - 1].imag(), above = L[i].imag();
    if ((below > 0.0) == (above > 0.0) || std::isnan(found.crossover_Hz)) continue;
    const double real = L[i - 1].real() + below / (below - above) * (L[i].real() - L[i - 1].real());
    if (!(real < 0.0) || (found.is_stable && real < -1.0)) continue;
    const double margin = -20.0 * std::log10(-real);
    if (!(margin >= found.gain_dB)) found.gain_dB = margin;
  }
  return found;
}

std::optional<Interval95> interval(double value, const std::vector<Values>& repeated, double Values::*which) {
  if (std::isnan(value)) return std::nullopt;
  double sum = 0.0, count = 0.0;
  for (const Values& one : repeated)
    if (!std::isnan(one.*which)) {
      sum += (one.*which - value) * (one.*which - value);
      ++count;
    }
  const double reach = count > 0.0 ? kNormal95 * std::sqrt(sum / count) : 0.0;
  return Interval95{value, {value - reach, value + reach}};
}

}  // namespace

OpenLoop open_loop(const FrequencyResponse& response, const PlantFit& fit, const AxisController& controller) {
  return FineLoop(response, fit, controller).loop();
}

FinePlant fine_plant(const FrequencyResponse& response, const PlantFit& fit) {
  struct Channel {
    std::vector<double> f_Hz, spread;
    std::vector<Complex> ratio;
  };
  std::array<Channel, 2> channels;
  for (Eigen::Index at = 0; at < 2; ++at) {
    std::vector<bool> clear;
    for (const ResponseLine& line : response.lines) clear.push_back(stands_out(line, Eigen::Vector2cd::Unit(at)));
    Channel& channel = channels[static_cast<std::size_t>(at)];
    for (const std::size_t place : places_of(clear)) {
      const ResponseLine& line = response.lines[place];
      const Complex fitted = fit.at(line.f_Hz)(at);
      channel.f_Hz.push_back(line.f_Hz);
      channel.ratio.push_back(line.plant(at) / fitted);
      channel.spread.push_back(half_width_95(line, Eigen::Vector2cd::Unit(at)) / (kNormal95 * std::abs(fitted)) + 1e-6);
    }
  }
  FinePlant fine{fine_frequencies(channels[static_cast<std::size_t>(response.channel())].f_Hz, fit), {}};
  for (const double f : fine.f_Hz) {
    Eigen::Vector2cd plant = fit.at(f);
    for (Eigen::Index at = 0; at < 2; ++at) {
      const Channel& channel = channels[static_cast<std::size_t>(at)];
      const Smoother smoother = smoother_at(f, channel.f_Hz, channel.spread);
      Complex sum = 0.0;
      for (std::size_t k = 0; k < smoother.weight.size(); ++k)
        sum += smoother.weight[k] * channel.ratio[smoother.first + k];
      plant(at) *= sum;
    }
    fine.plant.push_back(plant);
  }
  return fine;
}

FinePlant fine_plant(const PlantFit& fit) {
  constexpr double kLowest_Hz = 0.2, kHighestShare = 0.48;
  FinePlant fine{fine_frequencies({kLowest_Hz, kHighestShare / fit.sample_period_s}, fit), {}};
  for (const double f : fine.f_Hz) fine.plant.push_back(fit.at(f));
  return fine;
}

LoopMargins quick_margins(const FinePlant& drive, const AxisController& controller) {
  std::vector<Complex> L;
  for (std::size_t i = 0; i < drive.f_Hz.size(); ++i) L.push_back((controller.at(drive.f_Hz[i]) * drive.plant[i])(0));
  const Values found = values_of(drive.f_Hz, L);
  LoopMargins margins;
  margins.is_stable = found.is_stable;
  margins.gain_dB = interval(found.gain_dB, {}, &Values::gain_dB);
  margins.phase_deg = interval(found.phase_deg, {}, &Values::phase_deg);
  margins.modulus = interval(found.modulus, {}, &Values::modulus);
  margins.crossover_Hz = interval(found.crossover_Hz, {}, &Values::crossover_Hz);
  margins.modulus_at_Hz = found.modulus_at_Hz;
  return margins;
}

LoopMargins margins_of(const FrequencyResponse& response, const PlantFit& fit, const AxisController& controller) {
  const FineLoop loop(response, fit, controller);
  const Values found = values_of(loop.loop().fine_f_Hz, loop.loop().fine_L);
  std::mt19937 random(1);
  std::vector<Values> repeated;
  for (int i = 0; i < kRepetitions; ++i) repeated.push_back(values_of(loop.loop().fine_f_Hz, loop.repetition(random)));
  LoopMargins margins;
  margins.is_stable = found.is_stable;
  margins.gain_dB = interval(found.gain_dB, repeated, &Values::gain_dB);
  margins.phase_deg = interval(found.phase_deg, repeated, &Values::phase_deg);
  margins.modulus = interval(found.modulus, repeated, &Values::modulus);
  margins.crossover_Hz = interval(found.crossover_Hz, repeated, &Values::crossover_Hz);
  margins.modulus_at_Hz = found.modulus_at_Hz;
  return margins;
}

}  // namespace host
