#include "host/response/robust_method.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace host {

namespace {

using Complex = std::complex<double>;

/// Number of neighbouring lines whose disturbances are assumed equal. In the output's units disturbances are smooth
/// over frequency, also in closed loop.
constexpr std::size_t kNeighbours = 1;

Complex turned(double turns) { return std::polar(1.0, 2.0 * std::numbers::pi * turns); }

/// Mean over periods, relative to a period of the excitation with all phases 0.
struct Realisation {
  std::vector<Complex> u;
  std::vector<Eigen::Vector2cd> y;
};

Realisation mean_of(const PeriodicRun& run) {
  const std::size_t lines = run.excitation.lines.size();
  Realisation mean{std::vector<Complex>(lines), std::vector<Eigen::Vector2cd>(lines, Eigen::Vector2cd::Zero())};
  const double periods = static_cast<double>(run.period.size());
  for (const auto& period : run.period)
    for (std::size_t i = 0; i < lines; ++i) {
      const Complex back =
          turned(run.excitation.phases_turns.empty() ? 0.0 : -run.excitation.phases_turns[i]) / periods;
      mean.u[i] += period[i].u * back;
      mean.y[i] += Eigen::Vector2cd(period[i].x, period[i].w) * back;
    }
  return mean;
}

/// Records begin anywhere within a period. Shifts by whole samples so that the command's response aligns with that of
/// the first realisation. Takes unknown phases from the command itself.
void align(Realisation& one, const Realisation& first, const MultisineHeader& excitation) {
  const std::size_t lines = excitation.lines.size();
  if (excitation.phases_turns.empty()) {
    for (std::size_t i = 0; i < lines; ++i) {
      const Complex back = std::abs(one.u[i]) > 0.0 ? std::conj(one.u[i]) / std::abs(one.u[i]) : Complex(1.0);
      one.u[i] *= back;
      one.y[i] *= back;
    }
    return;
  }
  std::vector<Complex> ratio(lines);
  for (std::size_t i = 0; i < lines; ++i) {
    const double size = std::abs(one.u[i]) * std::abs(first.u[i]);
    ratio[i] = size > 0.0 ? one.u[i] * std::conj(first.u[i]) / size : Complex(0.0);
  }
  const auto back = [&](std::size_t i, std::size_t samples) {
    return turned(-static_cast<double>(excitation.lines[i] * samples % excitation.period) /
                  static_cast<double>(excitation.period));
  };
  double best = -std::numeric_limits<double>::infinity();
  std::size_t delay = 0;
  for (std::size_t samples = 0; samples < excitation.period; ++samples) {
    double sum = 0.0;
    for (std::size_t i = 0; i < lines; ++i) sum += (ratio[i] * back(i, samples)).real();
    if (sum > best) {
      best = sum;
      delay = samples;
    }
  }
  for (std::size_t i = 0; i < lines; ++i) {
    one.u[i] *= back(i, delay);
    one.y[i] *= back(i, delay);
  }
}

/// Covariance of a mean of `deviations`.
struct Spread {
  Eigen::Matrix2cd sum = Eigen::Matrix2cd::Zero();
  double degrees = 0.0;
  void add(const Eigen::Vector2cd& deviation) { sum += deviation * deviation.adjoint(); }
};

/// Sums over neighbouring lines, per degree of freedom.
std::vector<Spread> pooled(const std::vector<Spread>& lines) {
  std::vector<Spread> wide(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::size_t width = std::min(2 * kNeighbours + 1, lines.size());
    const std::size_t first = std::min(i > kNeighbours ? i - kNeighbours : 0, lines.size() - width);
    for (std::size_t k = first; k < first + width; ++k) {
      wide[i].sum += lines[k].sum;
      wide[i].degrees += lines[k].degrees;
    }
    if (wide[i].degrees > 0.0) wide[i].sum /= wide[i].degrees;
  }
  return wide;
}

}  // namespace

std::vector<ResponseLine> robust_response(const std::vector<PeriodicRun>& runs) {
  const MultisineHeader& excitation = runs.front().excitation;
  const std::size_t count = excitation.lines.size();
  const double realisations = static_cast<double>(runs.size());
  std::vector<Realisation> means;
  for (const PeriodicRun& run : runs) {
    means.push_back(mean_of(run));
    align(means.back(), means.front(), excitation);
  }
  std::vector<ResponseLine> lines(count);
  std::vector<Spread> between(count), within(count);
  std::vector<double> command_power(count);
  for (std::size_t i = 0; i < count; ++i) {
    Complex u = 0.0;
    Eigen::Vector2cd y = Eigen::Vector2cd::Zero();
    for (const Realisation& one : means) {
      u += one.u[i] / realisations;
      y += one.y[i] / realisations;
    }
    command_power[i] = std::norm(u);
    lines[i].f_Hz = static_cast<double>(excitation.lines[i]) /
                    (static_cast<double>(excitation.period) * runs.front().sample_period_s);
    lines[i].plant = y / u;
    for (std::size_t m = 0; m < runs.size(); ++m) {
      between[i].add(means[m].y[i] - lines[i].plant * means[m].u[i]);
      const Eigen::Vector2cd own = means[m].y[i] / means[m].u[i];  // of this realisation: excludes nonlinearity
      double periods = 0.0;
      Spread one;
      for (const auto& period : runs[m].period) {
        one.add(Eigen::Vector2cd(period[i].x, period[i].w) - own * period[i].u);
        ++periods;
      }
      within[i].sum += one.sum / periods;  // variance of the mean of that realisation
      within[i].degrees += periods - 1.0;
    }
    between[i].degrees = realisations - 1.0;
  }
  const std::vector<Spread> noise = pooled(within), total = pooled(between);
  for (std::size_t i = 0; i < count; ++i) {
    const double power = command_power[i] * realisations;
    const Eigen::Matrix2cd by_noise = noise[i].sum / power, all = total[i].sum / power;
    const bool is_single = runs.size() < 2;
    lines[i].covariance = is_single ? by_noise : all;
    lines[i].degrees = is_single ? noise[i].degrees : total[i].degrees;
    const Eigen::Index channel = std::abs(lines[i].plant(0)) > 0.0 ? 0 : 1;
    const double noise_power = by_noise(channel, channel).real();
    lines[i].noise = std::sqrt(0.5 * noise_power);
    const double rest = all(channel, channel).real() - noise_power;
    lines[i].nonlinearity = is_single ? 0.0 : std::sqrt(0.5 * realisations * std::max(0.0, rest));
  }
  return lines;
}

}  // namespace host
