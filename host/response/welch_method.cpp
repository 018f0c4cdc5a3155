#include "host/response/welch_method.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "host/fourier.hpp"

namespace host {

namespace {

using Complex = std::complex<double>;

constexpr double kStretch_s = 1.0;          ///< length of a segment: lines 1 Hz apart
constexpr std::size_t kFewestSegments = 8;  ///< least number of segments; they are shortened to reach it
constexpr double kHighest = 0.4;            ///< highest frequency relative to the sample rate
constexpr double kChance = 0.05;
constexpr std::size_t kLowest = 2;  ///< lowest line; below it the window's main lobe reaches 0 Hz

/// Cross-spectra at one frequency, summed over segments.
struct Sums {
  double uu = 0.0, rr = 0.0;
  Complex ur = 0.0;
  Eigen::Vector2cd yr = Eigen::Vector2cd::Zero(), yu = Eigen::Vector2cd::Zero();
  Eigen::Matrix2cd yy = Eigen::Matrix2cd::Zero();
};

std::size_t stretch_of(const std::vector<Record>& records) {
  std::size_t samples = 0;
  for (const Record& record : records) samples += record.size();
  const double wanted = std::min(kStretch_s / records.front().sample_period_s,
                                 2.0 * static_cast<double>(samples) / static_cast<double>(kFewestSegments + 1));
  return static_cast<std::size_t>(std::exp2(std::round(std::log2(std::max(16.0, wanted)))));
}

std::vector<double> increments(const std::vector<double>& x) {
  std::vector<double> found(x.size());
  for (std::size_t k = 0; k + 1 < x.size(); ++k) found[k] = x[k + 1] - x[k];
  if (x.size() > 1) found.back() = found[x.size() - 2];
  return found;
}

bool moves(const std::vector<double>& reference) {
  const auto [least, most] = std::ranges::minmax_element(reference);
  return !reference.empty() && *most > *least;
}

class Averages {
 public:
  explicit Averages(std::size_t length) : window_(hann_window(length)), sums_(length / 2 + 1) {}

  void add(const Record& record, bool is_indirect) {
    const std::vector<double> dx = increments(record.x);
    const std::vector<double>& r = is_indirect ? record.w_ref : record.u_V;
    for (std::size_t from = 0; from + window_.size() <= record.size(); from += window_.size() / 2, ++stretches_) {
      const auto U = spectrum(record.u_V, from), R = spectrum(r, from), X = spectrum(dx, from),
                 W = spectrum(record.w, from);
      for (std::size_t i = 0; i < sums_.size(); ++i) {
        const Eigen::Vector2cd y(X[i], W[i]);
        sums_[i].uu += std::norm(U[i]);
        sums_[i].rr += std::norm(R[i]);
        sums_[i].ur += U[i] * std::conj(R[i]);
        sums_[i].yr += y * std::conj(R[i]);
        sums_[i].yu += y * std::conj(U[i]);
        sums_[i].yy += y * y.adjoint();
      }
    }
  }

  std::size_t stretches() const { return stretches_; }

  std::vector<ResponseLine> lines(double sample_period_s) const {
    std::vector<ResponseLine> found;
    // Equivalent number of independent segments for Hann windows with half overlap (Harris 1978).
    const double count =
        18.0 * static_cast<double>(stretches_ * stretches_) / (19.0 * static_cast<double>(stretches_) - 1.0);
    if (count < 2.0) return found;
    const double chance = 1.0 - std::pow(kChance, 1.0 / (count - 1.0));
    for (std::size_t i = kLowest; i < sums_.size(); ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(window_.size());
      const Sums& s = sums_[i];
      if (share > kHighest || !(std::abs(s.ur) > 0.0)) continue;
      ResponseLine line;
      line.f_Hz = share / sample_period_s;
      const Eigen::Vector2cd G = s.yr / s.ur;
      const Eigen::Matrix2cd rest = s.yy - G * s.yu.adjoint() - s.yu * G.adjoint() + G * G.adjoint() * s.uu;
      // Converts increments to position.
      const Complex step = std::polar(1.0, 2.0 * std::numbers::pi * share) - 1.0;
      const Eigen::DiagonalMatrix<Complex, 2> integral(1.0 / step, 1.0);
      line.plant = integral * G;
      line.covariance =
          integral * rest * integral.toDenseMatrix().adjoint() * (s.rr / (std::norm(s.ur) * (count - 1.0)));
      line.degrees = 2.0 * (count - 1.0);
      const Eigen::Index channel = s.yy(0, 0).real() > 0.0 ? 0 : 1;
      const double answer = std::norm(s.yr(channel)) / (s.rr * s.yy(channel, channel).real());
      line.coherence = std::min(answer, std::norm(s.ur) / (s.rr * s.uu));
      line.noise = std::sqrt(0.5 * line.covariance(channel, channel).real());
      if (line.coherence > chance) found.push_back(line);
    }
    return found;
  }

 private:
  std::vector<Complex> spectrum(const std::vector<double>& x, std::size_t from) const {
    if (x.empty()) return std::vector<Complex>(sums_.size());
    std::vector<double> part(x.begin() + static_cast<std::ptrdiff_t>(from),
                             x.begin() + static_cast<std::ptrdiff_t>(from + window_.size()));
    double mean = 0.0;
    for (const double value : part) mean += value / static_cast<double>(part.size());
    for (std::size_t k = 0; k < part.size(); ++k) part[k] = (part[k] - mean) * window_[k];
    return spectrum_of(part);
  }

  std::vector<double> window_;
  std::vector<Sums> sums_;
  std::size_t stretches_ = 0;
};

}  // namespace

WelchResponse welch_response(const std::vector<Record>& records) {
  WelchResponse found;
  found.is_indirect = std::ranges::all_of(records, [](const Record& record) { return moves(record.w_ref); });
  Averages averages(stretch_of(records));
  for (const Record& record : records) averages.add(record, found.is_indirect);
  found.stretches = averages.stretches();
  found.lines = averages.lines(records.front().sample_period_s);
  return found;
}

}  // namespace host
