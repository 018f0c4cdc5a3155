#include "host/identify/zero_phase_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "host/cancellation.hpp"

namespace host {

using std::numbers::pi;

ZeroPhaseLowPass ZeroPhaseLowPass::butterworth(double cutoff_Hz, double sample_rate_Hz) {
  std::array<PolePair, kButterworthSections> poles;
  for (std::size_t k = 0; k < poles.size(); ++k) {
    const double angle = pi * (2.0 * static_cast<double>(k) + 1.0) / (4.0 * static_cast<double>(poles.size()));
    poles[k] = {-std::sin(angle), std::cos(angle)};
  }
  return {poles, cutoff_Hz, sample_rate_Hz};
}

ZeroPhaseLowPass ZeroPhaseLowPass::chebyshev(double cutoff_Hz, double sample_rate_Hz) {
  constexpr double kRipple_dB = 0.05;
  std::array<PolePair, kChebyshevSections> poles;
  const double order = 2.0 * static_cast<double>(poles.size());
  const double mu = std::asinh(1.0 / std::sqrt(std::pow(10.0, kRipple_dB / 10.0) - 1.0)) / order;
  for (std::size_t k = 0; k < poles.size(); ++k) {
    const double angle = pi * (2.0 * static_cast<double>(k) + 1.0) / (2.0 * order);
    poles[k] = {-std::sinh(mu) * std::sin(angle), std::cosh(mu) * std::cos(angle)};
  }
  return {poles, cutoff_Hz, sample_rate_Hz};
}

ZeroPhaseLowPass::ZeroPhaseLowPass(std::span<const PolePair> poles, double cutoff_Hz, double sample_rate_Hz) {
  if (!(cutoff_Hz > 0.0) || !(cutoff_Hz < 0.5 * sample_rate_Hz)) {
    throw std::invalid_argument("the cut-off must lie between 0 and half the sampling rate");
  }
  const double warped = std::tan(pi * cutoff_Hz / sample_rate_Hz);  // bilinear transform, pre-warped
  for (const PolePair& pole : poles) {
    const double damping = -2.0 * pole.real * warped;
    const double square = (pole.real * pole.real + pole.imaginary * pole.imaginary) * warped * warped;
    const double norm = 1.0 + damping + square;
    const double gain = square / norm;  // gain 1 at 0 Hz for every section
    sections_.push_back({gain, 2.0 * gain, gain, 2.0 * (square - 1.0) / norm, (1.0 - damping + square) / norm});
  }
  const double periods = static_cast<double>(3 * poles.size());  // steeper filters have a longer response
  extension_ = static_cast<std::size_t>(std::ceil(periods * sample_rate_Hz / cutoff_Hz));
}

template <std::size_t count, typename Sample>
void ZeroPhaseLowPass::cascade(std::vector<Sample>& signal) const {
  // Transposed direct form II, started in the steady state of the first sample. Every sample passes through all
  // sections before the next, because the processor overlaps the sections' recurrences.
  std::array<Section, count> sections;
  std::array<Sample, count> first, second;
  for (std::size_t k = 0; k < count; ++k) {
    sections[k] = sections_[k];
    first[k] = signal.front() * (1.0 - sections[k].b0);
    second[k] = signal.front() * (sections[k].b2 - sections[k].a2);
  }
  for (Sample& sample : signal)
    for (std::size_t k = 0; k < count; ++k) {
      const Section& s = sections[k];
      const Sample out = s.b0 * sample + first[k];
      first[k] = s.b1 * sample - s.a1 * out + second[k];
      second[k] = s.b2 * sample - s.a2 * out;
      sample = out;
    }
}

template <typename Sample>
void ZeroPhaseLowPass::run_once(std::vector<Sample>& signal) const {
  if (sections_.size() == kButterworthSections)
    cascade<kButterworthSections>(signal);
  else
    cascade<kChebyshevSections>(signal);
}

template <typename Sample>
std::vector<Sample> ZeroPhaseLowPass::filtered(std::span<const Sample> signal) const {
  throw_if_cancelled();  // the longest step of a comparison of a long record
  const std::size_t n = signal.size();
  if (n < 2) return {signal.begin(), signal.end()};
  const std::size_t margin = std::min(extension_, n - 1);
  std::vector<Sample> extended(n + 2 * margin);
  for (std::size_t k = 0; k < margin; ++k) {
    extended[k] = 2.0 * signal[0] - signal[margin - k];
    extended[margin + n + k] = 2.0 * signal[n - 1] - signal[n - 2 - k];
  }
  std::ranges::copy(signal, extended.begin() + static_cast<std::ptrdiff_t>(margin));
  run_once(extended);
  std::ranges::reverse(extended);
  run_once(extended);
  std::ranges::reverse(extended);
  const auto begin = extended.begin() + static_cast<std::ptrdiff_t>(margin);
  return {begin, begin + static_cast<std::ptrdiff_t>(n)};
}

template std::vector<double> ZeroPhaseLowPass::filtered(std::span<const double>) const;
template std::vector<EightSamples> ZeroPhaseLowPass::filtered(std::span<const EightSamples>) const;

double decimation_cutoff_Hz(std::size_t factor, double sample_rate_Hz) {
  constexpr double kPassband = 0.8;
  return kPassband * 0.5 * sample_rate_Hz / static_cast<double>(factor);
}

std::vector<double> decimate(std::span<const double> signal, std::size_t factor, double sample_rate_Hz) {
  if (factor <= 1) return {signal.begin(), signal.end()};
  const std::vector<double> smooth =
      ZeroPhaseLowPass::chebyshev(decimation_cutoff_Hz(factor, sample_rate_Hz), sample_rate_Hz)(signal);
  std::vector<double> kept;
  kept.reserve(signal.size() / factor + 1);
  for (std::size_t k = 0; k < smooth.size(); k += factor) kept.push_back(smooth[k]);
  return kept;
}

std::vector<double> central_difference(std::span<const double> signal, double sample_period_s) {
  const std::size_t n = signal.size();
  std::vector<double> slope(n);
  if (n < 2) return slope;
  for (std::size_t k = 1; k + 1 < n; ++k) slope[k] = (signal[k + 1] - signal[k - 1]) / (2.0 * sample_period_s);
  slope[0] = (signal[1] - signal[0]) / sample_period_s;
  slope[n - 1] = (signal[n - 1] - signal[n - 2]) / sample_period_s;
  return slope;
}

}  // namespace host
