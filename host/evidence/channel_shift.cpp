#include "host/evidence/channel_shift.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "host/dense_solutions.hpp"
#include "host/exit_codes.hpp"
#include "host/identify/effort_timing.hpp"
#include "host/identify/zero_phase_filter.hpp"
#include "sim/drive.hpp"

namespace host {

namespace {

constexpr int kMostSamples = 30;
constexpr double kWhole = 0.1;         ///< a logger shifts by whole samples: a shift within this distance of one counts
constexpr double kPlain = 0.05;        ///< any other shift counts if it leaves at most this part of the squares
constexpr double kLogLikelihood = 20;  ///< difference that decides between two explanations

/// The shift with the smallest value, among -kMostSamples..kMostSamples, interpolated by a parabola; empty if it is at
/// an end.
std::optional<double> lowest_shift(const std::vector<double>& squares) {
  const auto lowest = std::ranges::min_element(squares) - squares.begin();
  const auto at = static_cast<std::size_t>(lowest);
  if (at == 0 || at + 1 == squares.size()) return {};
  const double left = squares[at - 1], middle = squares[at], right = squares[at + 1];
  const double bend = left - 2.0 * middle + right;
  if (!(bend > 0.0)) return {};
  return static_cast<double>(lowest) - kMostSamples + 0.5 * (left - right) / bend;
}

/// Sum of squares of `target` after least squares on `regressors`.
double squares_left(const Eigen::MatrixXd& regressors, const Eigen::VectorXd& target) {
  const Eigen::VectorXd cross = regressors.transpose() * target;
  return std::max(0.0, target.squaredNorm() - cross.dot(symmetric_solution(gram(regressors), cross)));
}

/// Part of the squared torque or force at `rows` that inertia and friction do not explain, for each shift.
std::vector<double> rigid_squares(const Motion& motion, std::span<const std::size_t> rows) {
  const auto count = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd regressors(count, 4);
  for (Eigen::Index row = 0; row < count; ++row) {
    const std::size_t k = rows[static_cast<std::size_t>(row)];
    regressors.row(row) << motion.acceleration[k], motion.speed[k], motion.speed[k] > 0.0 ? 1.0 : 0.0,
        motion.speed[k] < 0.0 ? 1.0 : 0.0;
  }
  Eigen::MatrixXd normal = gram(regressors);
  normal.diagonal() *= 1.0 + 1e-9;  // singular if a record has only one direction
  std::vector<double> squares;
  Eigen::VectorXd effort(count);
  for (int shift = -kMostSamples; shift <= kMostSamples; ++shift) {
    for (Eigen::Index row = 0; row < count; ++row)
      effort(row) = motion.effort[static_cast<std::size_t>(
          static_cast<std::ptrdiff_t>(rows[static_cast<std::size_t>(row)]) + shift)];
    const Eigen::VectorXd cross = regressors.transpose() * effort;
    squares.push_back(std::max(0.0, effort.squaredNorm() - cross.dot(symmetric_solution(normal, cross))) /
                      effort.squaredNorm());
  }
  return squares;
}

}  // namespace

std::optional<Motion> motion_if_long_enough(const Record& record, const sim::DataSheet& data,
                                            const MotionOptions& options) {
  try {
    return prepare_motion(record, data, options);
  } catch (const Failure&) {
    return std::nullopt;
  }
}

std::optional<double> tachometer_shift(const Record& record, const sim::DataSheet& data) {
  const auto n = static_cast<Eigen::Index>(record.size());
  const Eigen::Index inner = n - 2 * kMostSamples;
  if (!record.has_position() || !record.has_speed() || inner < 200) return {};
  const double rate_Hz = 1.0 / record.sample_period_s;
  const double cutoff_Hz = choose_cutoff({record}, data);
  const auto low_pass = ZeroPhaseLowPass::butterworth(cutoff_Hz, rate_Hz);
  const std::vector<double> speed = smooth_speed(record, data, cutoff_Hz);
  const std::vector<double> tach = low_pass(record.w);
  const Eigen::VectorXd measured = Eigen::Map<const Eigen::VectorXd>(tach.data(), n).segment(kMostSamples, inner);
  Eigen::MatrixXd regressors(inner, 2);
  regressors.col(1).setOnes();
  std::vector<double> squares;
  for (int shift = -kMostSamples; shift <= kMostSamples; ++shift) {
    regressors.col(0) = Eigen::Map<const Eigen::VectorXd>(speed.data(), n).segment(kMostSamples - shift, inner);
    squares.push_back(squares_left(regressors, measured));
  }
  const std::optional<double> shift = lowest_shift(squares);
  if (!shift || std::abs(*shift) < 0.5) return {};
  // White noise below the cut-off has this many independent samples.
  const double independent = static_cast<double>(inner) * 2.0 * cutoff_Hz / rate_Hz;
  const auto index = static_cast<std::size_t>(std::lround(*shift) + kMostSamples);
  const bool whole = std::abs(*shift - std::round(*shift)) <= kWhole;
  if (!whole && squares[index] > kPlain * squares[kMostSamples]) return {};
  const auto better = [&](double other) { return 0.5 * independent * std::log(other / squares[index]); };
  if (better(squares[kMostSamples]) < kLogLikelihood) return {};
  if (*shift > 0.0) {
    // A lag that starts within a sample delays by up to half a sample more than its time constant.
    for (double lag = *shift - 0.75; lag < *shift + 0.8; lag += 0.25) {
      if (lag <= 0.0) continue;
      const double keep = std::exp(-1.0 / lag);
      double lagged = speed.front();
      for (Eigen::Index k = 0; k < n; ++k) {
        lagged = keep * lagged + (1.0 - keep) * speed[static_cast<std::size_t>(k)];
        if (k >= kMostSamples && k < kMostSamples + inner) regressors(k - kMostSamples, 0) = lagged;
      }
      if (better(squares_left(regressors, measured)) < kLogLikelihood) return {};
    }
  }
  return whole ? std::round(*shift) : *shift;
}

std::optional<double> command_shift(const Record& record, const sim::DriveDescription& model) {
  constexpr double kLatestAnswer_s = 0.015;  // dead time and current loop together
  constexpr double kFirstAnswer = 1.5;       // samples before the command; friction can look like one sample
  const double first_answer = record.u_V.empty() ? kLargestTiming : kFirstAnswer;
  constexpr double kGain = 0.15;       // the squares must fall to this part; static friction alone gives 0.25
  constexpr double kExplained = 0.02;  // of the squared torque or force; above it, friction determines the optimum
  constexpr double kAlike = 0.5;       // samples; largest difference between the halves of a record
  MotionOptions options;
  options.decimation = 1;
  const std::optional<Motion> prepared = motion_if_long_enough(record, model.data, options);
  if (!prepared) return {};
  const Motion& motion = *prepared;
  const std::size_t n = motion.speed.size();
  std::vector<std::size_t> rows;
  for (std::size_t k = kMostSamples; k + kMostSamples < n; ++k)
    if (motion.counts[k]) rows.push_back(k);
  if (rows.size() < 200) return {};
  const std::vector<double> squares = rigid_squares(motion, rows);
  const std::optional<double> shift = lowest_shift(squares);
  if (!shift) return {};
  const sim::Drive drive(model);
  const double modelled = (drive.delay_s + drive.current_lag_s) / record.sample_period_s;
  const double beyond = *shift + modelled;
  const bool too_early = beyond > first_answer;
  const bool too_late = -*shift * record.sample_period_s > kLatestAnswer_s;
  const auto index = static_cast<std::size_t>(std::lround(*shift) + kMostSamples);
  if (!too_early && !too_late) return {};
  if (std::abs(*shift - std::round(*shift)) > kWhole || squares[index] > kGain * squares[kMostSamples] ||
      squares[index] > kExplained)
    return {};
  // A logger shifts the whole record equally. Friction that the rigid model lacks looks like a shift only in parts of
  // it.
  const std::span<const std::size_t> all(rows);
  for (const auto half : {all.first(rows.size() / 2), all.last(rows.size() / 2)}) {
    const std::optional<double> own = lowest_shift(rigid_squares(motion, half));
    if (!own || std::abs(*own - *shift) > kAlike) return {};
  }
  return std::round(*shift);
}

}  // namespace host
