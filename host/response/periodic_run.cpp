#include "host/response/periodic_run.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <sstream>

#include "host/dense_solutions.hpp"
#include "host/exit_codes.hpp"
#include "host/fourier.hpp"

namespace host {

namespace {

constexpr double kSettling = 0.25;  ///< periods after the excitation has reached its full size
constexpr double kFade = 1.0;       ///< periods in which the board fades the excitation in
constexpr std::size_t kHops = 8;    ///< steps per period of the window that searches for the excitation
constexpr double kFullShare = 0.7;  ///< relative to the largest power: above it most of the window has full amplitude
constexpr double kPartly = 0.6;     ///< part of such a window that may belong to the fade-in

struct SampleRange {
  std::size_t from = 0, to = 0;
  std::size_t length() const { return to > from ? to - from : 0; }
};

template <typename Number>
std::vector<Number> numbers_in(const Record& record, const std::string& key) {
  std::vector<Number> numbers;
  const auto found = record.header.find(key);
  if (found == record.header.end()) return numbers;
  std::istringstream text(found->second);
  for (Number number; text >> number;) numbers.push_back(number);
  if (!text.eof())
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: # {}: {} is not a list of numbers", record.path, key, found->second));
  return numbers;
}

/// The longest range of samples for which `fits(k)` holds.
template <typename Fits>
SampleRange longest(std::size_t count, const Fits& fits) {
  SampleRange best, now;
  for (std::size_t k = 0; k < count; ++k) {
    if (!fits(k))
      now.from = k + 1;
    else if (now.to = k + 1; now.length() > best.length())
      best = now;
  }
  return best;
}

/// The range in which `x` repeats after one period, within `tolerance`.
SampleRange periodic_stretch(const std::vector<double>& x, std::size_t period, double tolerance) {
  if (x.size() <= period) return {};
  SampleRange found =
      longest(x.size() - period, [&](std::size_t k) { return std::abs(x[k + period] - x[k]) <= tolerance; });
  if (found.length() > 0) found.to += period;
  return found;
}

/// The range in which the command contains the lines at full amplitude.
SampleRange loud_stretch(const Record& record, const MultisineHeader& excitation) {
  const std::size_t hop = std::max<std::size_t>(1, excitation.period / kHops);
  std::vector<double> power;
  for (std::size_t k = 0; k + excitation.period <= record.size(); k += hop) {
    const auto spectrum = spectrum_of(std::span(record.u_V).subspan(k, excitation.period));
    double sum = 0.0;
    for (const std::size_t line : excitation.lines) sum += std::norm(spectrum[line]);
    power.push_back(sum);
  }
  if (power.empty()) return {};
  const double full = kFullShare * *std::ranges::max_element(power);
  const SampleRange windows = longest(power.size(), [&](std::size_t i) { return power[i] >= full; });
  const auto part = static_cast<std::size_t>(kPartly * static_cast<double>(excitation.period));
  return {windows.from * hop + part, (windows.to - 1) * hop + excitation.period - part};
}

bool has_ride(const Record& record) {
  const auto ride = record.header.find("excitation_ride");
  return ride != record.header.end() && !record.w_ref.empty();
}

SampleRange steady_stretch(const Record& record, const MultisineHeader& excitation) {
  const std::size_t settling = static_cast<std::size_t>(kSettling * static_cast<double>(excitation.period));
  if (!excitation.is_closed_loop) {
    const double most =
        std::abs(*std::ranges::max_element(record.u_V, {}, [](double volts) { return std::abs(volts); }));
    SampleRange found = periodic_stretch(record.u_V, excitation.period, 5e-3 * most);
    found.from += settling;
    return found;
  }
  if (!has_ride(record)) {
    SampleRange found = loud_stretch(record, excitation);
    found.from += settling;
    return found;
  }
  const double most =
      std::abs(*std::ranges::max_element(record.w_ref, {}, [](double speed) { return std::abs(speed); }));
  const auto begin = std::ranges::find_if(record.w_ref, [&](double speed) { return std::abs(speed) > 1e-6 * most; });
  const auto full = static_cast<std::size_t>(begin - record.w_ref.begin()) +
                    static_cast<std::size_t>(kFade * static_cast<double>(excitation.period));
  // A constant position means that the axis does not jog.
  const SampleRange found = longest(record.size(), [&](std::size_t k) {
    if (k < full || k + 1 >= record.size() || std::abs(record.w_ref[k]) < 0.05 * most) return false;
    if (!excitation.is_at_reference) return std::abs(record.w_ref[k + 1] - record.w_ref[k]) <= 1e-3 * most;
    return k + excitation.period >= record.size() ||
           std::abs(record.w_ref[k + excitation.period] - record.w_ref[k]) <= 2e-2 * most;
  });
  return {found.from + settling, found.to};
}

/// Subtracts a polynomial through the means of the periods: the jog's travel and slow drift.
void detrend(std::vector<double>& x, std::size_t period) {
  const std::size_t periods = x.size() / period;
  const int degree = periods > 3 ? 2 : 1;
  Eigen::MatrixXd powers(static_cast<Eigen::Index>(periods), degree + 1);
  Eigen::VectorXd means(static_cast<Eigen::Index>(periods));
  const double centre = 0.5 * static_cast<double>(x.size() - 1), scale = static_cast<double>(period);
  for (std::size_t p = 0; p < periods; ++p) {
    const auto row = static_cast<Eigen::Index>(p);
    double sum = 0.0;
    for (std::size_t k = 0; k < period; ++k) sum += x[p * period + k] - x.front();
    means(row) = sum / scale;
    const double at = (static_cast<double>(p * period) + 0.5 * (scale - 1.0) - centre) / scale;
    for (int power = 0; power <= degree; ++power) powers(row, power) = std::pow(at, power);
  }
  const Eigen::VectorXd found = least_squares_solution(powers, means);
  const double start = x.front();
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double at = (static_cast<double>(k) - centre) / scale;
    x[k] -= start + found(0) + at * (found(1) + (degree > 1 ? at * found(2) : 0.0));
  }
}

}  // namespace

std::optional<MultisineHeader> multisine_of(const Record& record) {
  const auto kind = record.header.find("excitation");
  if (kind == record.header.end() || kind->second != "multisine") return std::nullopt;
  MultisineHeader found;
  const auto period = numbers_in<std::size_t>(record, "excitation_period_samples");
  found.lines = numbers_in<std::size_t>(record, "excitation_lines");
  found.phases_turns = numbers_in<double>(record, "excitation_phases_turns");
  const auto input = record.header.find("excitation_input");
  found.is_at_reference = input != record.header.end() && input->second == "reference";
  found.is_closed_loop = input != record.header.end() && input->second != "open loop";
  const bool is_whole = period.size() == 1 && period.front() >= 8 && !found.lines.empty() && found.lines.front() > 0 &&
                        std::ranges::is_sorted(found.lines, std::ranges::less_equal()) &&
                        2 * found.lines.back() < period.front() &&
                        (found.phases_turns.empty() || found.phases_turns.size() == found.lines.size());
  if (!is_whole)
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: its header describes a multisine, but period, lines and phases are inconsistent",
                              record.path));
  found.period = period.front();
  return found;
}

PeriodicRun periodic_run(const Record& record, const MultisineHeader& excitation) {
  const SampleRange steady = steady_stretch(record, excitation);
  const std::size_t periods = steady.length() / excitation.period;
  if (periods < 2)
    throw Failure(
        ExitCode::refused,
        fmt::format("{}: {} samples of the excitation are steady, which is less than two of its periods of {}: "
                    "record longer, or in a wider box, so that the jog does not reverse",
                    record.path, steady.length(), excitation.period));
  PeriodicRun run{excitation, record.sample_period_s, {}, {}, {}, {}, {}};
  for (std::size_t line = excitation.lines.front(); line <= excitation.lines.back(); ++line)
    if (!std::ranges::binary_search(excitation.lines, line))
      (line % 2 == 0 ? run.even_lines : run.odd_lines).push_back(line);
  const auto part = [&](const std::vector<double>& channel) -> std::vector<double> {
    if (channel.empty()) return {};
    const auto from = channel.begin() + static_cast<std::ptrdiff_t>(steady.from);
    return {from, from + static_cast<std::ptrdiff_t>(periods * excitation.period)};
  };
  const std::vector<double> u = part(record.u_V), w = part(record.w);
  std::vector<double> x = part(record.x);
  if (!x.empty()) detrend(x, excitation.period);
  for (std::size_t p = 0; p < periods; ++p) {
    const auto spectrum = [&](const std::vector<double>& channel) {
      if (channel.empty()) return std::vector<std::complex<double>>(excitation.period / 2 + 1);
      return spectrum_of(std::span(channel).subspan(p * excitation.period, excitation.period));
    };
    const auto U = spectrum(u), X = spectrum(x), W = spectrum(w);
    const auto pick = [&](const std::vector<std::size_t>& lines) {
      std::vector<PeriodicRun::Sample> samples;
      for (const std::size_t line : lines) samples.push_back({U[line], X[line], W[line]});
      return samples;
    };
    run.period.push_back(pick(excitation.lines));
    run.odd.push_back(pick(run.odd_lines));
    run.even.push_back(pick(run.even_lines));
  }
  return run;
}

}  // namespace host
