#include "host/opening/drive_constants.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "host/dense_solutions.hpp"
#include "host/record/position_grid.hpp"

namespace host {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kFewest = 100;  // samples

/// Noise from second differences (factor 1 + 4 + 1 = 6) in intervals without a change of the position.
std::optional<double> noise_at_rest(const std::vector<double>& position, const std::vector<double>& current) {
  constexpr std::size_t kQuiet = 20;  // samples before and after
  std::vector<std::size_t> still(position.size(), 0);
  for (std::size_t k = 1; k < position.size(); ++k)
    if (position[k] == position[k - 1]) still[k] = still[k - 1] + 1;
  double squares = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 2; k + kQuiet < current.size(); ++k) {
    if (still[k + kQuiet] < 2 * kQuiet) continue;
    const double bend = current[k] - 2.0 * current[k - 1] + current[k - 2];
    if (!std::isfinite(bend)) continue;
    squares += bend * bend;
    ++count;
  }
  if (count < kFewest || !(squares > 0.0)) return {};
  return std::sqrt(squares / 6.0 / static_cast<double>(count));
}

/// Regression of y on some columns and an offset: the factors, and the share of the squares of y that remains.
struct Regression {
  VectorXd factors;
  double left = 1.0;
};
Regression regress(const VectorXd& y, const std::vector<const VectorXd*>& by) {
  MatrixXd columns(y.size(), static_cast<Index>(by.size()));
  for (std::size_t c = 0; c < by.size(); ++c) columns.col(static_cast<Index>(c)) = by[c]->array() - by[c]->mean();
  const VectorXd centred = y.array() - y.mean();
  const double all = centred.squaredNorm();
  if (!(all > 0.0)) return {VectorXd::Zero(columns.cols()), 1.0};
  const VectorXd factors = least_squares_solution(columns, centred);
  return {factors, (centred - columns * factors).squaredNorm() / all};
}

/// A relation is accepted if it leaves less than this share of the squares, which is a tenth of the signal.
constexpr double kHolds = 0.01;
/// A second cause is accepted if it leaves at most this share of the squares that the first one leaves, which is half
/// of the error.
constexpr double kNeeded = 0.25;

/// Whether this voltage determines the current.
bool find_electrical(const LoggedMotion& logged, const std::vector<double>& volts, DriveConstants& constants) {
  const bool has_speed = logged.speed.size() == logged.current.size();
  std::vector<std::size_t> whole;
  for (std::size_t k = 0; k < logged.current.size(); ++k)
    if (std::isfinite(logged.current[k]) && std::isfinite(volts[k]) && (!has_speed || std::isfinite(logged.speed[k])))
      whole.push_back(k);
  if (whole.size() < kFewest) return false;
  const auto taken = [&](const std::vector<double>& values) {
    VectorXd some(static_cast<Index>(whole.size()));
    for (std::size_t k = 0; k < whole.size(); ++k) some(static_cast<Index>(k)) = values[whole[k]];
    return some;
  };
  const VectorXd current = taken(logged.current), voltage = taken(volts);
  const Regression alone = regress(voltage, {&current});
  if (has_speed) {
    const VectorXd speed = taken(logged.speed);
    const Regression winding = regress(voltage, {&current, &speed});
    if (winding.left < kHolds && winding.left < kNeeded * alone.left && winding.factors(0) > 0.0 &&
        winding.factors(1) > 0.0) {
      constants.resistance_Ohm = winding.factors(0);
      constants.back_emf_V_s = winding.factors(1);
      return true;
    }
  }
  if (!(alone.left < kHolds) || !(alone.factors(0) > 0.0)) return false;
  constants.amplifier_gain_A_per_V = regress(current, {&voltage}).factors(0);
  return true;
}

}  // namespace

DriveConstants constants_of(const LoggedMotion& logged) {
  DriveConstants constants;
  constants.is_linear = logged.is_linear;
  if (const double step = position_grid(logged.position); step > 0.0) constants.encoder_step_mm = step;
  if (logged.current.size() == logged.position.size())
    constants.current_noise_A = noise_at_rest(logged.position, logged.current);
  for (const std::vector<double>& volts : logged.voltages)
    if (!logged.current.empty() && volts.size() == logged.current.size() && find_electrical(logged, volts, constants))
      break;
  return constants;
}

std::string constants_words(const DriveConstants& constants) {
  std::vector<std::string> words;
  const auto add = [&](const std::optional<double>& value, const char* format) {
    if (value) words.push_back(fmt::format(fmt::runtime(format), *value));
  };
  add(constants.encoder_step_mm, "encoder step {:.6g} mm");
  add(constants.current_noise_A, "noise of the current at rest {:.3g} A");
  add(constants.amplifier_gain_A_per_V, "amplifier {:.4g} A/V");
  add(constants.resistance_Ohm, "winding {:.3g} Ohm");
  add(constants.back_emf_V_s, constants.is_linear ? "back-EMF {0:.4g} V s/m (a DC motor's constant is {0:.4g} N/A)"
                                                  : "back-EMF {0:.4g} V s/rad (a DC motor's constant is {0:.4g} Nm/A)");
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace host
