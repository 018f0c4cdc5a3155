#include "host/response/plant_fit.hpp"

#include <ceres/ceres.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/dense_solutions.hpp"
#include "host/exit_codes.hpp"
#include "host/identify/dense_matrix.hpp"
#include "host/identify/least_squares.hpp"

namespace host {

namespace {

using Complex = std::complex<double>;

using std::numbers::pi;
constexpr int kAliases = 4;            ///< images of the spectrum counted on each side
constexpr double kLeastSpread = 2e-3;  ///< relative: smaller uncertainties of lines are raised to this
constexpr int kIterations = 100, kTrial = 20;
constexpr std::size_t kMostModes = 3;
constexpr double kMostDamping = 0.3;  ///< of a resonance
constexpr double kStartDamping = 0.03;
constexpr double kEarns = 14.0;      ///< required decrease of chi^2 by a mode with four parameters; 9.5 has p = 0.05
constexpr double kEarnsShare = 0.1;  ///< required decrease as a share of the residual
constexpr double kLeastMode = 0.1;   ///< smallest mode at its resonance, relative to the rigid part

constexpr double kLagTells = 4.0;  ///< required decrease of chi^2 by a lag instead of a delay; p = 0.05
constexpr double kNoDelay = 0.05;  ///< smallest significant delay or lag, in samples

// Parameters of the fit: log gains, pole, delays, then (log frequency, log damping, shares) of each mode.
constexpr std::size_t kRigidValues = 5, kPerMode = 4, kDelay = 3;

/// Meaning of the value at kDelay.
enum class Late { delay, lag };

PlantFit unpack(const double* value, std::size_t modes, Late late, double sample_period_s) {
  PlantFit fit;
  fit.sample_period_s = sample_period_s;
  fit.position_gain = std::exp(value[0]);
  fit.speed_gain = std::exp(value[1]);
  fit.pole = value[2];
  (late == Late::delay ? fit.delay_s : fit.lag_s).value = value[kDelay] * sample_period_s;
  fit.speed_delay_s = value[4] * sample_period_s;
  for (std::size_t i = 0; i < modes; ++i) {
    const double* mode = value + kRigidValues + i * kPerMode;
    Resonance resonance;
    resonance.f_Hz.value = std::exp(mode[0]);
    resonance.damping.value = std::exp(mode[1]);
    resonance.position_share = mode[2];
    resonance.speed_share = mode[3];
    fit.resonances.push_back(resonance);
  }
  return fit;
}

/// Residuals of a response, the real and imaginary parts each divided by their standard deviation.
class Deviations {
 public:
  explicit Deviations(const FrequencyResponse& response) : response_(response) {
    for (const ResponseLine& line : response.lines)
      for (Eigen::Index channel = 0; channel < 2; ++channel) {
        if (!stands_out(line, Eigen::Vector2cd::Unit(channel))) continue;
        const double spread = std::sqrt(0.5 * line.covariance(channel, channel).real()) / std::abs(line.plant(channel));
        points_.push_back({line.f_Hz, channel, line.plant(channel), std::hypot(spread, kLeastSpread)});
      }
  }

  std::size_t count() const { return 2 * points_.size(); }

  void operator()(const PlantFit& fit, double* out) const {
    double last_f = -1.0;
    Eigen::Vector2cd plant;
    for (const Point& point : points_) {
      if (point.f_Hz != last_f) plant = fit.at(last_f = point.f_Hz);
      const Complex off = std::log(point.measured / plant(point.channel));
      *out++ = off.real() / point.spread;
      *out++ = off.imag() / point.spread;
    }
  }

  double sum_of_squares(const PlantFit& fit) const {
    std::vector<double> off(count());
    (*this)(fit, off.data());
    double sum = 0.0;
    for (const double one : off) sum += one * one;
    return sum;
  }

  double lowest() const { return response_.lines.front().f_Hz; }
  double highest() const { return response_.lines.back().f_Hz; }
  double sample_period_s() const { return response_.sample_period_s; }

  /// Starting value of the gain: a double integrator through the middle lines.
  double start_gain(Eigen::Index channel) const {
    std::vector<double> gains;
    for (const Point& point : points_)
      if (point.channel == channel)
        gains.push_back(std::abs(point.measured) * std::pow(2.0 * pi * point.f_Hz, channel == 0 ? 2 : 1));
    if (gains.empty()) return 1.0;
    std::ranges::nth_element(gains, gains.begin() + static_cast<std::ptrdiff_t>(gains.size() / 3));
    return gains[gains.size() / 3];
  }

 private:
  struct Point {
    double f_Hz;
    Eigen::Index channel;
    Complex measured;
    double spread;
  };
  const FrequencyResponse& response_;
  std::vector<Point> points_;
};

struct Functor {
  const Deviations& deviations;
  std::size_t modes;
  Late late;
  bool operator()(double const* const* value, double* out) const {
    deviations(unpack(value[0], modes, late, deviations.sample_period_s()), out);
    return true;
  }
};

struct Fitted {
  std::vector<double> value;
  Late late = Late::delay;
  double chi2 = 0.0;
  Eigen::MatrixXd covariance;

  std::size_t modes() const { return (value.size() - kRigidValues) / kPerMode; }
};

/// `iterations`: a few suffice to compare starting values.
Fitted solve(const Deviations& deviations, std::vector<double> value, Late late, int iterations) {
  const std::size_t modes = (value.size() - kRigidValues) / kPerMode;
  auto* cost = new ceres::DynamicNumericDiffCostFunction<Functor, ceres::FORWARD>(new Functor{deviations, modes, late});
  cost->AddParameterBlock(static_cast<int>(value.size()));
  cost->SetNumResiduals(static_cast<int>(deviations.count()));
  ceres::Problem problem;
  problem.AddResidualBlock(cost, nullptr, value.data());
  problem.SetParameterLowerBound(value.data(), kDelay, late == Late::delay ? -0.5 : 0.0);
  problem.SetParameterUpperBound(value.data(), kDelay, 20.0);
  for (std::size_t i = 0; i < modes; ++i) {
    const int at = static_cast<int>(kRigidValues + i * kPerMode);
    problem.SetParameterLowerBound(value.data(), at, std::log(0.8 * deviations.lowest()));
    problem.SetParameterUpperBound(value.data(), at, std::log(1.25 * deviations.highest()));
    problem.SetParameterLowerBound(value.data(), at + 1, std::log(1e-3));
    problem.SetParameterUpperBound(value.data(), at + 1, std::log(0.7));
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = iterations;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  Fitted found{std::move(value), late, 2.0 * summary.final_cost, {}};
  if (iterations < kIterations) return found;
  ceres::CRSMatrix sparse;
  if (!problem.Evaluate({}, nullptr, nullptr, nullptr, &sparse))
    throw Failure(ExitCode::refused, "no drive fits the response: the fit diverges");
  const Eigen::MatrixXd jacobian = dense_matrix(sparse);
  found.covariance = pseudo_inverse(gram(jacobian));
  return found;
}

/// The mode that lowers chi^2 most: a search on a grid of frequencies, observed at the load, at the motor, or one at
/// each; the solver starts from the best grid points. `plain`: values of a fit without any mode. A fit without this
/// mode distorts other parameters (mostly a delay) to imitate it, which misleads the grid.
Fitted with_one_more(const Deviations& deviations, const Fitted& before, const std::vector<double>& plain) {
  constexpr int kGrid = 120, kStarts = 4;
  constexpr std::array<std::array<double, 2>, 3> kShares{{{-0.95, -0.95}, {-0.95, 0.4}, {0.4, 0.4}}};
  std::vector<std::pair<double, std::vector<double>>> starts;
  const bool is_first = before.value.size() == plain.size();
  for (int i = 0; i < (is_first ? 2 : 1) * kGrid; ++i)
    for (const auto& [position_share, speed_share] : kShares) {
      std::vector<double> value = i < kGrid ? before.value : plain;
      const double part = (i % kGrid + 0.5) / kGrid;
      value.insert(value.end(), {std::log(deviations.lowest()) * (1.0 - part) + std::log(deviations.highest()) * part,
                                 std::log(kStartDamping), position_share, speed_share});
      const std::size_t modes = (value.size() - kRigidValues) / kPerMode;
      const PlantFit fit = unpack(value.data(), modes, before.late, deviations.sample_period_s());
      starts.emplace_back(deviations.sum_of_squares(fit), std::move(value));
    }
  std::ranges::sort(starts, {}, [](const auto& start) { return start.first; });
  Fitted best = before;
  std::vector<double> tried;
  for (const auto& [chi2, value] : starts) {
    const double log_f = value[value.size() - kPerMode];
    if (std::ranges::any_of(tried, [&](double other) { return std::abs(other - log_f) < 0.05; })) continue;
    tried.push_back(log_f);
    if (Fitted one = solve(deviations, value, before.late, kTrial); one.chi2 < best.chi2) best = std::move(one);
    if (tried.size() == kStarts) break;
  }
  return best.value.size() > before.value.size() ? solve(deviations, best.value, before.late, kIterations) : best;
}

bool is_mode(const double* mode, const Deviations& deviations) {
  const double f = std::exp(mode[0]), damping = std::exp(mode[1]);
  const double at_resonance = std::max(std::abs(mode[2]), std::abs(mode[3])) / (2.0 * damping);
  return f > deviations.lowest() && f < deviations.highest() && at_resonance > kLeastMode && damping < kMostDamping;
}

/// Whether an earlier mode lies within the width of this one, so that both describe one resonance.
bool has_twin(const std::vector<double>& value, std::size_t at) {
  for (std::size_t other = kRigidValues; other < at; other += kPerMode)
    if (std::abs(value[other] - value[at]) < std::exp(value[other + 1]) + std::exp(value[at + 1])) return true;
  return false;
}

/// Removes modes that a later mode has made superfluous.
void drop_what_is_no_mode(std::vector<double>& value, const Deviations& deviations) {
  for (std::size_t at = kRigidValues; at < value.size();)
    if (is_mode(value.data() + at, deviations) && !has_twin(value, at))
      at += kPerMode;
    else
      value.erase(value.begin() + static_cast<std::ptrdiff_t>(at),
                  value.begin() + static_cast<std::ptrdiff_t>(at + kPerMode));
}

/// Adds modes while each is significant.
Fitted with_modes(const Deviations& deviations, Late late) {
  const std::vector<double> plain = {std::log(deviations.start_gain(0)), std::log(deviations.start_gain(1)), 1.0, 0.1,
                                     0.0};
  Fitted fitted = solve(deviations, plain, late, kTrial);
  for (std::size_t modes = 0; modes < kMostModes; ++modes) {
    if (deviations.count() < fitted.value.size() + kPerMode + 2) break;
    Fitted next = with_one_more(deviations, fitted, plain);
    const double count = static_cast<double>(deviations.count());
    // If the fit is worse than the noise, the residual is used as the noise.
    const double unit = std::max(1.0, next.chi2 / (count - static_cast<double>(next.value.size())));
    const double fall = fitted.chi2 - next.chi2;
    if (fall < kEarns * unit || fall < kEarnsShare * fitted.chi2 || next.value.size() == fitted.value.size() ||
        !is_mode(next.value.data() + next.value.size() - kPerMode, deviations))
      break;
    fitted = std::move(next);
  }
  drop_what_is_no_mode(fitted.value, deviations);
  return solve(deviations, fitted.value, late, kIterations);
}

/// Uses a lag if it explains more, or as much with fewer modes: with a delay alone, modes are needed to shape
/// magnitudes.
Fitted fitted_best(const Deviations& deviations) {
  Fitted delayed = with_modes(deviations, Late::delay);
  if (delayed.modes() == 0 && delayed.value[kDelay] < kNoDelay) return delayed;
  Fitted lagging = with_modes(deviations, Late::lag);
  const double count = static_cast<double>(deviations.count());
  const double free = std::max(1.0, count - static_cast<double>(delayed.value.size()));
  const double unit = std::max(1.0, std::min(delayed.chi2, lagging.chi2) / free);
  const auto cost = [&](const Fitted& one) { return one.chi2 / unit + kEarns * static_cast<double>(one.modes()); };
  return lagging.value[kDelay] >= kNoDelay && cost(lagging) + kLagTells < cost(delayed) ? lagging : delayed;
}

}  // namespace

Eigen::Vector2cd PlantFit::at(double f_Hz) const {
  const double rate = 1.0 / sample_period_s;
  Eigen::Vector2cd sum = Eigen::Vector2cd::Zero();
  for (int image = -kAliases; image <= kAliases; ++image) {
    const Complex s(0.0, 2.0 * pi * (f_Hz + image * rate));
    Complex x = 1.0 / (s * (s + pole)), w = 1.0 / (s + pole);
    for (const Resonance& mode : resonances) {
      const double omega = 2.0 * pi * mode.f_Hz.value;
      const Complex one = 1.0 / (s * s + 2.0 * mode.damping.value * omega * s + omega * omega);
      x += mode.position_share * one;
      w += mode.speed_share * one * s;
    }
    const Complex held = (1.0 - std::exp(-s * sample_period_s)) / (s * sample_period_s) * std::exp(-s * delay_s.value) /
                         (1.0 + s * lag_s.value);
    sum += Eigen::Vector2cd(position_gain * x * held, speed_gain * w * held * std::exp(-s * speed_delay_s));
  }
  return sum;
}

PlantFit fit_plant(const FrequencyResponse& response) {
  const Deviations deviations(response);
  if (response.lines.size() < 6 || deviations.count() < 12)
    throw Failure(ExitCode::refused, fmt::format("{} lines of the response exceed the noise: too few to fit a drive",
                                                 deviations.count() / 2));
  const Fitted fitted = fitted_best(deviations);
  PlantFit fit = unpack(fitted.value.data(), fitted.modes(), fitted.late, response.sample_period_s);
  const double free = std::max(1.0, static_cast<double>(deviations.count() - fitted.value.size()));
  fit.misfit = std::sqrt(fitted.chi2 / free);
  const double factor = student_t_95(free) * std::max(1.0, fit.misfit);
  const auto reach = [&](std::size_t i) {
    const auto at = static_cast<Eigen::Index>(i);
    return factor * std::sqrt(std::max(0.0, fitted.covariance(at, at)));
  };
  const double delay = reach(kDelay) * response.sample_period_s;
  Interval95& late = fitted.late == Late::delay ? fit.delay_s : fit.lag_s;
  late.ci95 = {late.value - delay, late.value + delay};
  for (std::size_t i = 0; i < fit.resonances.size(); ++i) {
    Resonance& mode = fit.resonances[i];
    const auto scaled = [&](Interval95& value, std::size_t at) {
      value.ci95 = {value.value * std::exp(-reach(at)), value.value * std::exp(reach(at))};
    };
    scaled(mode.f_Hz, kRigidValues + i * kPerMode);
    scaled(mode.damping, kRigidValues + i * kPerMode + 1);
  }
  std::ranges::sort(fit.resonances, {}, [](const Resonance& mode) { return mode.f_Hz.value; });
  return fit;
}

std::optional<double> lowest_resonance_Hz(const PlantFit& fit) {
  const auto lowest =
      std::ranges::min_element(fit.resonances, {}, [](const Resonance& mode) { return mode.f_Hz.value; });
  return lowest == fit.resonances.end() ? std::nullopt : std::optional(lowest->f_Hz.value);
}

}  // namespace host
