#include "host/evidence/period_search.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>

#include "host/fourier.hpp"

namespace host {

namespace {

using std::numbers::pi;

/// Sums of the signal on a grid of travel, and the power of their spectrum at the grid's harmonics.
std::vector<double> power_spectrum(const TravelSignal& signal, double origin, double cell, std::size_t cells) {
  std::vector<double> sums(cells, 0.0);
  for (std::size_t k = 0; k < signal.x.size(); ++k)
    sums[static_cast<std::size_t>((signal.x[k] - origin) / cell)] += signal.value[k] * signal.weight[k];
  const std::vector<std::complex<double>> spectrum = spectrum_of(sums);
  std::vector<double> power(spectrum.size());
  std::ranges::transform(spectrum, power.begin(), [](const std::complex<double>& value) { return std::norm(value); });
  return power;
}

/// Least squares at orders around a peak, within the resolution of the grid.
PeriodPeak refine(const TravelSignal& signal, double order, double order_step) {
  PeriodPeak best = peak_at(signal, 1.0 / order);
  constexpr int kSteps = 8;
  for (int step = -kSteps; step <= kSteps; ++step) {
    const double near = order + step * order_step / kSteps;
    if (near <= 0.0) continue;
    const PeriodPeak peak = peak_at(signal, 1.0 / near);
    if (peak.share > best.share) best = peak;
  }
  return best;
}

}  // namespace

PeriodPeak peak_at(const TravelSignal& signal, double period) {
  double cc = 0.0, cs = 0.0, ss = 0.0, cv = 0.0, sv = 0.0, vv = 0.0;
  for (std::size_t k = 0; k < signal.x.size(); ++k) {
    const double c = signal.weight[k] * std::cos(2.0 * pi * signal.x[k] / period);
    const double s = signal.weight[k] * std::sin(2.0 * pi * signal.x[k] / period);
    const double v = signal.value[k];
    cc += c * c;
    cs += c * s;
    ss += s * s;
    cv += c * v;
    sv += s * v;
    vv += v * v;
  }
  const double determinant = cc * ss - cs * cs;
  if (determinant <= 1e-9 * cc * ss || vv <= 0.0) return {period, 0.0, 0.0, 0.0};
  const double cosine = (ss * cv - cs * sv) / determinant;
  const double sine = (cc * sv - cs * cv) / determinant;
  return {period, cosine, sine, (cosine * cv + sine * sv) / vv};
}

std::vector<PeriodPeak> find_periods(const TravelSignal& signal, double shortest, double longest, std::size_t most) {
  std::vector<PeriodPeak> peaks;
  if (signal.x.size() < 8) return peaks;
  const auto [low, high] = std::ranges::minmax(signal.x);
  const double travel = high - low;
  if (travel <= 2.0 * shortest) return peaks;
  // Zero padding to four times the travel resolves every peak. Eight cells per period represent even the shortest
  // period.
  constexpr double kPadding = 4.0, kCellsPerPeriod = 8.0;
  constexpr std::size_t kMostCells = std::size_t{1} << 20;
  std::size_t cells = 1024;
  while (cells < kMostCells && static_cast<double>(cells) < kPadding * travel * kCellsPerPeriod / shortest) cells *= 2;
  const double cell = kPadding * travel / static_cast<double>(cells) * (1.0 + 1e-9);
  const std::vector<double> power = power_spectrum(signal, low, cell, cells);
  const double order_step = 1.0 / (cell * static_cast<double>(cells));

  std::vector<std::size_t> maxima;
  for (std::size_t k = 1; k + 1 < power.size(); ++k) {
    const double order = static_cast<double>(k) * order_step;
    if (order < 1.0 / longest || order > 1.0 / shortest) continue;
    if (power[k] >= power[k - 1] && power[k] > power[k + 1]) maxima.push_back(k);
  }
  std::ranges::sort(maxima, [&](std::size_t a, std::size_t b) { return power[a] > power[b]; });
  for (const std::size_t k : maxima) {
    if (peaks.size() >= 3 * most) break;
    const double order = static_cast<double>(k) * order_step;
    const bool known = std::ranges::any_of(
        peaks, [&](const PeriodPeak& peak) { return std::abs(1.0 / peak.period - order) < 1.5 / travel; });
    if (!known) peaks.push_back(refine(signal, order, order_step));
  }
  std::ranges::sort(peaks, [](const PeriodPeak& a, const PeriodPeak& b) { return a.share > b.share; });
  if (peaks.size() > most) peaks.resize(most);
  return peaks;
}

}  // namespace host
