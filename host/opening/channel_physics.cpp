#include "host/opening/channel_physics.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/dense_solutions.hpp"

namespace host {

namespace {

/// Largest number of equations: enough for four digits of a factor, independent of the length of the log.
constexpr std::size_t kMostRowsRead = 20'000;

struct Fit {
  Eigen::VectorXd coefficients, deviations;
  double r_squared = 0.0;
};

/// Least squares of y on the columns of `x` and a constant. Empty if the columns are not independent.
std::optional<Fit> fit(Eigen::MatrixXd x, const Eigen::VectorXd& y) {
  const Eigen::Index rows = x.rows(), columns = x.cols();
  if (rows < columns + 10) return std::nullopt;
  const Eigen::RowVectorXd means = x.colwise().mean();
  x.rowwise() -= means;
  const Eigen::VectorXd centred = y.array() - y.mean();
  const double total = centred.squaredNorm();
  const Eigen::RowVectorXd norms = x.colwise().norm();
  if (!(total > 0.0) || !std::isfinite(total) || !(norms.minCoeff() > 0.0) || !norms.allFinite()) return std::nullopt;
  x.array().rowwise() /= norms.array();
  const Eigen::MatrixXd moments = gram(x);
  Fit result;
  result.coefficients = symmetric_solution(moments, Eigen::VectorXd(x.transpose() * centred));
  const double rest = (centred - x * result.coefficients).squaredNorm();
  result.r_squared = 1.0 - rest / total;
  const Eigen::MatrixXd inverse = symmetric_inverse(moments);
  result.deviations = (inverse.diagonal().array().abs() * rest / static_cast<double>(rows - columns - 1)).sqrt();
  result.coefficients.array() /= norms.transpose().array();
  result.deviations.array() /= norms.transpose().array();
  if (!result.coefficients.allFinite()) return std::nullopt;
  return result;
}

bool is_finite(const std::vector<double>& values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

std::vector<double> running_mean(const std::vector<double>& values, std::size_t width) {
  std::vector<double> means;
  double sum = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    sum += values[k];
    if (k >= width) sum -= values[k - width];
    if (k + 1 >= width) means.push_back(sum / static_cast<double>(width));
  }
  return means;
}

/// Uses every n-th row, so that at most kMostRowsRead remain.
std::size_t stride_of(std::size_t rows) { return std::max<std::size_t>(1, rows / kMostRowsRead); }

}  // namespace

std::optional<Proportion> change_over_speed(const std::vector<double>& position, const std::vector<double>& speed,
                                            double period_s) {
  const std::size_t rows = std::min(position.size(), speed.size());
  if (rows < 60 || !is_finite(position) || !is_finite(speed) || !(period_s > 0.0)) return std::nullopt;
  std::vector<double> integral(rows, 0.0);
  for (std::size_t k = 1; k < rows; ++k) integral[k] = integral[k - 1] + 0.5 * period_s * (speed[k] + speed[k - 1]);
  std::optional<Proportion> best;
  for (const std::size_t stretch : {rows / 200, rows / 50, rows / 20}) {
    const std::size_t width = std::max<std::size_t>(stretch, 2), count = rows - width, stride = stride_of(count);
    const auto equations = static_cast<Eigen::Index>(count / stride);
    Eigen::MatrixXd x(equations, 1);
    Eigen::VectorXd y(equations);
    for (Eigen::Index k = 0; k < equations; ++k) {
      const std::size_t at = static_cast<std::size_t>(k) * stride;
      x(k, 0) = integral[at + width] - integral[at];
      y(k) = position[at + width] - position[at];
    }
    const auto found = fit(std::move(x), y);
    if (found && (!best || found->r_squared > best->r_squared))
      best = Proportion{found->coefficients(0), found->r_squared, found->deviations(0)};
  }
  return best;
}

std::optional<Proportion> follows(const std::vector<double>& raw_measured, const std::vector<double>& raw_reference) {
  if (raw_measured.size() != raw_reference.size() || raw_measured.size() < 60) return std::nullopt;
  if (!is_finite(raw_measured) || !is_finite(raw_reference)) return std::nullopt;
  // In fast motion a control loop overshoots, so only the slow part of the measurement equals the reference.
  const std::size_t width = std::max<std::size_t>(1, raw_measured.size() / 10);
  const std::vector<double> measured = running_mean(raw_measured, width),
                            reference = running_mean(raw_reference, width);
  const std::size_t rows = measured.size();
  const std::size_t half = std::clamp<std::size_t>(rows / 1000, 1, 10), stride = stride_of(rows);
  const auto equations = static_cast<Eigen::Index>((rows - 2 * half) / stride);
  Eigen::MatrixXd x(equations, 3);
  Eigen::VectorXd y(equations);
  for (Eigen::Index k = 0; k < equations; ++k) {
    const std::size_t at = half + static_cast<std::size_t>(k) * stride;
    x(k, 0) = reference[at];
    x(k, 1) = reference[at + half] - reference[at - half];
    x(k, 2) = reference[at + half] - 2.0 * reference[at] + reference[at - half];
    y(k) = measured[at];
  }
  const auto found = fit(std::move(x), y);
  if (!found) return std::nullopt;
  return Proportion{found->coefficients(0), found->r_squared, found->deviations(0)};
}

std::optional<double> effort_by_motion(const std::vector<double>& position, const std::vector<double>& effort) {
  const std::size_t rows = std::min(position.size(), effort.size());
  if (rows < 200 || !is_finite(position) || !is_finite(effort)) return std::nullopt;
  const std::size_t half = std::clamp<std::size_t>(rows / 400, 2, 40);
  const std::size_t count = rows - 2 * half, stride = stride_of(count);
  const auto equations = static_cast<Eigen::Index>(count / stride);
  Eigen::MatrixXd x(equations, 3);
  Eigen::VectorXd y(equations);
  for (Eigen::Index k = 0; k < equations; ++k) {
    const std::size_t at = half + static_cast<std::size_t>(k) * stride;
    const double speed = position[at + half] - position[at - half];
    x(k, 0) = position[at + half] - 2.0 * position[at] + position[at - half];
    x(k, 1) = speed;
    x(k, 2) = speed > 0.0 ? 1.0 : speed < 0.0 ? -1.0 : 0.0;
    double mean = 0.0;
    for (std::size_t j = at - half; j <= at + half; ++j) mean += effort[j];
    y(k) = mean / static_cast<double>(2 * half + 1);
  }
  const auto found = fit(std::move(x), y);
  return found ? std::optional(std::clamp(found->r_squared, 0.0, 1.0)) : std::nullopt;
}

std::optional<double> wrap_range(const std::vector<double>& position) {
  if (position.size() < 60 || !is_finite(position)) return std::nullopt;
  const auto [low, high] = std::ranges::minmax(position);
  std::vector<double> jumps;
  for (std::size_t k = 1; k < position.size(); ++k) {
    const double step = position[k] - position[k - 1];
    // The step without the jump would have been about as large as the one before.
    const double before = k >= 2 ? position[k - 1] - position[k - 2] : 0.0;
    if (std::abs(step) > 0.6 * (high - low)) jumps.push_back(std::abs(step - before));
  }
  // A single jump may mean that two logs were joined.
  if (jumps.size() < 2 || 10 * jumps.size() > position.size()) return std::nullopt;
  const auto [least, most] = std::ranges::minmax(jumps);
  constexpr double kAlike = 0.05;
  if (most - least > kAlike * most || high - low < 0.9 * least) return std::nullopt;
  return std::accumulate(jumps.begin(), jumps.end(), 0.0) / static_cast<double>(jumps.size());
}

bool are_whole(const std::vector<double>& values) {
  constexpr double kMoreThanTurns = 50.0;
  const auto [low, high] = std::ranges::minmax(values);
  return high - low > kMoreThanTurns &&
         std::ranges::all_of(values, [](double value) { return value == std::floor(value); });
}

std::optional<int> sign_bit(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    if (value < 0.0 || value != std::floor(value)) return std::nullopt;
    largest = std::max(largest, value);
  }
  for (const int bit : {15, 10, 31}) {
    const double weight = std::ldexp(1.0, bit);
    if (largest <= weight || largest >= 2.0 * weight) continue;
    double plain = 0.0, magnitude = 0.0;
    std::size_t below = 0, above = 0;
    for (const double value : values) {
      if (!std::isfinite(value)) continue;
      (value >= weight ? magnitude : plain) =
          std::max(value >= weight ? magnitude : plain, value >= weight ? value - weight : value);
      ++(value >= weight ? above : below);
    }
    // Both signs reach about equally far, and there are no values between.
    if (above > 2 && below > 2 && plain < 0.6 * weight && magnitude < 0.6 * weight) return bit;
  }
  return std::nullopt;
}

std::vector<double> without_sign_bit(std::vector<double> values, int bit) {
  const double weight = std::ldexp(1.0, bit);
  for (double& value : values)
    if (value >= weight) value = weight - value;
  return values;
}

}  // namespace host
