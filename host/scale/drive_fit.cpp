#include "host/scale/drive_fit.hpp"

#include <ceres/ceres.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <random>
#include <span>

#include "host/cancellation.hpp"
#include "host/dense_solutions.hpp"
#include "host/parallel.hpp"

namespace host {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kStudentDegrees = 4.0;  // degrees of freedom of the t distribution, see infer/evidence.hpp

std::vector<DriveRange> free_numbers(const TableDrive& drive, double deceleration) {
  std::vector<DriveRange> numbers = shape_ranges(drive, deceleration);
  // Bounds of real machines: 1 mm of free travel, and resonances of 3 Hz to 3 kHz with the motor held.
  if (drive.gap > 0.0) numbers.push_back({DriveNumber::gap, std::log(1e-5), std::log(1.0), 0.02, 0.0, HUGE_VAL});
  if (drive.lag > 0.0) numbers.push_back({DriveNumber::lag, std::log(2.8e-9), std::log(2.8e-3), 0.02, 0.0, HUGE_VAL});
  return numbers;
}

/// y minus the table's motion and the other columns, whitened.
class Remainder {
 public:
  Remainder(const TableRows& rows, const Evidence& evidence, const MatrixXd& others, const NoiseColour& colour)
      : rows_(rows), evidence_(evidence), colour_(colour) {
    const MatrixXd white = evidence.whiten(others, colour);
    taken_ = orthonormal_basis(white);
  }

  /// One column per drive.
  MatrixXd of(std::span<const TableDrive> drives) const {
    MatrixXd left(rows_.size(), static_cast<Index>(drives.size()));
    const std::vector<DrivenRows> driven = drive_tables(drives, rows_);
    for (Index k = 0; k < left.cols(); ++k) left.col(k) = rows_.y - driven[static_cast<std::size_t>(k)].all;
    const MatrixXd white = evidence_.whiten(left, colour_);
    return white - taken_ * (taken_.transpose() * white);
  }
  VectorXd of(const TableDrive& drive) const { return of(std::span(&drive, 1)); }
  /// The residual for a table that follows the motor.
  VectorXd of_none() const {
    const VectorXd white = evidence_.whiten(rows_.y, colour_);
    return white - taken_ * (taken_.transpose() * white);
  }

  /// The most probable scale of the noise for these residuals.
  double scale_of(const VectorXd& left) const {
    const double least = evidence_.least_noise() * evidence_.least_noise();
    double square = std::max(0.25 * left.squaredNorm() / static_cast<double>(left.size()), least);
    constexpr int kRounds = 20;
    for (int round = 0; round < kRounds; ++round) {
      const Eigen::ArrayXd squares = left.array().square();
      const double next = ((kStudentDegrees + 1.0) * squares / (kStudentDegrees + squares / square)).mean();
      square = std::max(next, least);
    }
    return std::sqrt(square);
  }

  /// Twice the negative log likelihood.
  double cost_of(const VectorXd& left) const {
    const double scale = scale_of(left);
    return 2.0 * static_cast<double>(left.size()) * std::log(scale) +
           (kStudentDegrees + 1.0) * (left.array().square() / (kStudentDegrees * scale * scale)).log1p().sum();
  }

 private:
  const TableRows& rows_;
  const Evidence& evidence_;
  NoiseColour colour_;
  MatrixXd taken_;  ///< orthonormal
};

class DriveCost : public ceres::CostFunction {
 public:
  DriveCost(const TableDrive& start, const std::vector<DriveRange>& numbers, const Remainder& remainder, Index rows,
            double scale)
      : start_(start), numbers_(numbers), remainder_(remainder), rows_(rows), scale_(scale) {
    set_num_residuals(static_cast<int>(rows_) + static_cast<int>(numbers.size()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(numbers.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const auto columns = static_cast<Index>(numbers_.size());
    const Eigen::Map<const VectorXd> at(parameters[0], columns);
    const bool slopes = jacobians != nullptr && jacobians[0] != nullptr;
    MatrixXd points = at.replicate(1, slopes ? columns + 1 : 1);
    for (Index column = 0; slopes && column < columns; ++column) {
      const DriveRange& one = numbers_[static_cast<std::size_t>(column)];
      points(column, column + 1) += at(column) + one.step > one.high ? -one.step : one.step;
    }
    const MatrixXd values = at_numbers(points);
    Eigen::Map<VectorXd>(residuals, num_residuals()) = values.col(0);
    if (!values.allFinite() || is_cancelled()) return false;
    if (!slopes) return true;
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> jacobian(
        jacobians[0], num_residuals(), columns);
    for (Index column = 0; column < columns; ++column)
      jacobian.col(column) = (values.col(column + 1) - values.col(0)) / (points(column, column + 1) - at(column));
    return true;
  }

 private:
  /// One column per point.
  MatrixXd at_numbers(const MatrixXd& points) const {
    std::vector<TableDrive> drives(static_cast<std::size_t>(points.cols()), start_);
    MatrixXd all(num_residuals(), points.cols());
    for (Index point = 0; point < points.cols(); ++point)
      for (Index k = 0; k < points.rows(); ++k) {
        const DriveRange& one = numbers_[static_cast<std::size_t>(k)];
        set_number(drives[static_cast<std::size_t>(point)], one.which, points(k, point));
        all(rows_ + k, point) = (points(k, point) - one.middle) / one.deviation;
      }
    const Eigen::ArrayXXd left = remainder_.of(drives).array() / scale_;
    all.topRows(rows_) = left.sign() * ((kStudentDegrees + 1.0) * (left.square() / kStudentDegrees).log1p()).sqrt();
    return all;
  }

  const TableDrive& start_;
  const std::vector<DriveRange>& numbers_;
  const Remainder& remainder_;
  Index rows_;
  double scale_;
};

/// Fits with the noise scale of the start.
TableDrive settled(TableDrive drive, const std::vector<DriveRange>& numbers, const Remainder& remainder, Index rows,
                   int iterations) {
  const double scale = remainder.scale_of(remainder.of(drive));
  const TableDrive start = drive;
  std::vector<double> at;
  ceres::Problem problem;
  for (const DriveRange& one : numbers) at.push_back(std::clamp(number_of(drive, one.which), one.low, one.high));
  problem.AddResidualBlock(new DriveCost(start, numbers, remainder, rows, scale), nullptr, at.data());
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    problem.SetParameterLowerBound(at.data(), static_cast<int>(k), numbers[k].low);
    problem.SetParameterUpperBound(at.data(), static_cast<int>(k), numbers[k].high);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = iterations;
  options.function_tolerance = 1e-5;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  throw_if_cancelled();
  if (!summary.IsSolutionUsable()) return drive;
  for (std::size_t k = 0; k < numbers.size(); ++k) set_number(drive, numbers[k].which, at[k]);
  return drive;
}

/// Drives near a given one, in the directions that are determined least: along each principal axis of the information,
/// and between two of them, from one standard deviation to many. The first is the drive itself.
std::vector<TableDrive> cloud_about(const TableDrive& drive, const std::vector<DriveRange>& numbers,
                                    const Remainder& remainder, Index rows) {
  const auto count = static_cast<Index>(numbers.size());
  const DriveCost cost(drive, numbers, remainder, rows, remainder.scale_of(remainder.of(drive)));
  VectorXd at(count), residuals(rows + count);
  for (Index k = 0; k < count; ++k) at(k) = number_of(drive, numbers[static_cast<std::size_t>(k)].which);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> jacobian(rows + count, count);
  const double* const parameters[] = {at.data()};
  double* jacobians[] = {jacobian.data()};
  if (!cost.Evaluate(parameters, residuals.data(), jacobians)) return {drive};
  const SymmetricSpectrum axes = symmetric_spectrum(jacobian.transpose() * jacobian);
  const MatrixXd deviations = axes.vectors * axes.values.cwiseMax(1e-9).cwiseSqrt().cwiseInverse().asDiagonal();
  constexpr int kDirections = 16;
  std::mt19937 seed(1);
  std::normal_distribution<double> normal;
  std::vector<TableDrive> cloud = {drive};
  for (int k = 0; k < kDirections; ++k) {
    const VectorXd direction = deviations * VectorXd::NullaryExpr(count, [&] { return normal(seed); });
    for (const double length : {1.0, 4.0, 16.0, 64.0}) {
      cloud.push_back(drive);
      for (Index n = 0; n < count; ++n) {
        const DriveRange& one = numbers[static_cast<std::size_t>(n)];
        set_number(cloud.back(), one.which, std::clamp(at(n) + length * direction(n), one.low, one.high));
      }
    }
  }
  return cloud;
}

}  // namespace

TableDrive fit_drive(std::vector<TableDrive> starts, const TableRows& rows, const Evidence& evidence,
                     const MatrixXd& others, const NoiseColour& colour, double deceleration) {
  const std::vector<DriveRange> numbers = free_numbers(starts.front(), deceleration);
  const Remainder remainder(rows, evidence, others, colour);
  const bool is_new = starts.size() > 1;
  double least = HUGE_VAL;
  const auto price = [&](int iterations) {
    std::vector<std::pair<double, std::size_t>> costs(starts.size());
    if (iterations > 0)
      for_each_in_parallel(starts.size(), [&](std::size_t k) {
        starts[k] = settled(starts[k], numbers, remainder, rows.size(), iterations);
      });
    constexpr std::size_t kAtOnce = 16;
    for_each_in_parallel((starts.size() + kAtOnce - 1) / kAtOnce, [&](std::size_t part) {
      const std::size_t first = part * kAtOnce, count = std::min(kAtOnce, starts.size() - first);
      const MatrixXd left = remainder.of(std::span(starts).subspan(first, count));
      for (std::size_t k = 0; k < count; ++k)
        costs[first + k] = {remainder.cost_of(left.col(static_cast<Index>(k))) + prior_cost(starts[first + k], numbers),
                            first + k};
    });
    std::ranges::sort(costs);
    std::vector<TableDrive> ordered;
    for (const auto& [cost, k] : costs) ordered.push_back(starts[k]);
    starts = std::move(ordered);
    least = costs.front().first;
  };
  price(0);
  // Drives with equal lost motion at a reversal have worse ones between them. So the best start for each gap, or for
  // each spring, is kept.
  std::vector<TableDrive> best_of_each;
  for (const TableDrive& start : starts)
    if (std::ranges::none_of(best_of_each, [&](const TableDrive& kept) {
          return start.gap > 0.0 ? kept.gap == start.gap : kept.lag == start.lag;
        }))
      best_of_each.push_back(start);
  starts = std::move(best_of_each);
  constexpr std::pair<std::size_t, int> kRounds[] = {{6, 6}, {4, 12}, {2, 20}};  // kept starts, iterations
  // A new drive is rejected if it does not fit better than a table that follows the motor once it moves.
  const double most = is_new ? remainder.cost_of(remainder.of_none()) : HUGE_VAL;
  const auto go_on = [&] {
    for (const auto& [kept, iterations] : kRounds) {
      starts.resize(std::min(kept, starts.size()));
      price(iterations);
      if (least >= most) return;
    }
  };
  go_on();
  // A table sticks, slides and touches, so there are worse fits between the best ones.
  constexpr int kClouds = 3;
  for (int cloud = 0; cloud < kClouds && least < most; ++cloud) {
    const double before = least;
    starts = cloud_about(starts.front(), numbers, remainder, rows.size());
    price(0);
    // A fit that only follows changes of other terms continues only if a drive of the cloud is better.
    if (!is_new && !(least < before - 1.0)) break;
    starts.resize(std::min<std::size_t>(is_new ? 2 : 1, starts.size()));
    price(12);
    if (!(least < before - 1.0)) break;
  }
  return starts.front();
}

}  // namespace host
