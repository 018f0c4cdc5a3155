// Low-pass filters without delay, applied forward and backward.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace host {

/// One sample of each of eight signals. Their recurrences run side by side, which takes a third of the time.
using EightSamples = Eigen::Array<double, 8, 1>;

/// A low-pass applied in both directions, so that nothing is shifted in time. Each direction starts from the steady
/// state of an odd extension of the signal, so that levels and ramps pass unchanged up to the ends. Cut-off in Hz, 0 <
/// cutoff < sample rate / 2; otherwise throws std::invalid_argument.
class ZeroPhaseLowPass {
 public:
  /// 4th-order Butterworth: -3 dB at the cut-off for one direction, -6 dB for both.
  static ZeroPhaseLowPass butterworth(double cutoff_Hz, double sample_rate_Hz);

  /// 8th-order Chebyshev with gain 1 at 0 Hz and a ripple of up to 0.05 dB (each direction). It is steep, and the usual
  /// guard filter before decimation.
  static ZeroPhaseLowPass chebyshev(double cutoff_Hz, double sample_rate_Hz);

  /// Filtered signal of the same length. Any length.
  std::vector<double> operator()(std::span<const double> signal) const { return filtered(signal); }
  /// The same for eight signals.
  std::vector<EightSamples> operator()(std::span<const EightSamples> signals) const { return filtered(signals); }

 private:
  struct Section {
    double b0, b1, b2, a1, a2;
  };
  struct PolePair {
    double real, imaginary;  ///< of the analogue prototype with cut-off 1 rad/s, real < 0
  };
  ZeroPhaseLowPass(std::span<const PolePair> poles, double cutoff_Hz, double sample_rate_Hz);
  template <typename Sample>
  std::vector<Sample> filtered(std::span<const Sample> signal) const;
  template <typename Sample>
  void run_once(std::vector<Sample>& signal) const;
  template <std::size_t count, typename Sample>
  void cascade(std::vector<Sample>& signal) const;

  static constexpr std::size_t kButterworthSections = 2, kChebyshevSections = 4;  ///< of second order

  std::vector<Section> sections_;
  std::size_t extension_;
};

/// 0.8 of the Nyquist rate after decimation, Hz.
double decimation_cutoff_Hz(std::size_t factor, double sample_rate_Hz);

/// Anti-alias filter (Chebyshev at decimation_cutoff_Hz), then every `factor`-th sample from the first.
/// A factor of 1 returns the signal unchanged.
std::vector<double> decimate(std::span<const double> signal, std::size_t factor, double sample_rate_Hz);

/// (y[k+1] - y[k-1]) / (2 Ts), in 1/s; one-sided at both ends.
std::vector<double> central_difference(std::span<const double> signal, double sample_period_s);

}  // namespace host
