#include "host/scale/drive_fit.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>

#include "host/cancellation.hpp"
#include "host/parallel.hpp"

namespace host {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kDegrees = 4.0;  // of the t distribution: see infer/evidence.hpp

std::vector<DriveRange> free_numbers(const TableDrive& drive, double deceleration) {
  std::vector<DriveRange> numbers = shape_ranges(drive, deceleration);
  // A size may be anything: bounds are those of machines, one mm of free travel and 3 Hz to 3 kHz with the motor held.
  if (drive.gap > 0.0) numbers.push_back({DriveNumber::gap, std::log(1e-5), std::log(1.0), 0.02, 0.0, HUGE_VAL});
  if (drive.lag > 0.0) numbers.push_back({DriveNumber::lag, std::log(2.8e-9), std::log(2.8e-3), 0.02, 0.0, HUGE_VAL});
  return numbers;
}

/// y less what the table does and what the other columns take, whitened.
class Remainder {
 public:
  Remainder(const TableRows& rows, const Evidence& evidence, const MatrixXd& others, double correlation)
      : rows_(rows), evidence_(evidence), correlation_(correlation) {
    const MatrixXd white = evidence.whiten(others, correlation);
    const Eigen::ColPivHouseholderQR<MatrixXd> factors(white);
    taken_ = factors.householderQ() * MatrixXd::Identity(white.rows(), factors.rank());
  }

  VectorXd of(const TableDrive& drive) const {
    const VectorXd white = evidence_.whiten(rows_.y - drive_table(drive, rows_).all, correlation_);
    return white - taken_ * (taken_.transpose() * white);
  }

  /// The noise's scale at which these are most probable.
  double scale_of(const VectorXd& left) const {
    const double least = evidence_.least_noise() * evidence_.least_noise();
    double square = std::max(0.25 * left.squaredNorm() / static_cast<double>(left.size()), least);
    constexpr int kRounds = 20;
    for (int round = 0; round < kRounds; ++round) {
      const Eigen::ArrayXd squares = left.array().square();
      const double next = ((kDegrees + 1.0) * squares / (kDegrees + squares / square)).mean();
      square = std::max(next, least);
    }
    return std::sqrt(square);
  }

  /// Twice the negative log likelihood.
  double cost_of(const VectorXd& left) const {
    const double scale = scale_of(left);
    return 2.0 * static_cast<double>(left.size()) * std::log(scale) +
           (kDegrees + 1.0) * (left.array().square() / (kDegrees * scale * scale)).log1p().sum();
  }

 private:
  const TableRows& rows_;
  const Evidence& evidence_;
  double correlation_;
  MatrixXd taken_;  ///< orthonormal
};

double prior_cost(const TableDrive& drive, const std::vector<DriveRange>& numbers) {
  double cost = 0.0;
  for (const DriveRange& one : numbers) cost += std::pow((number_of(drive, one.which) - one.middle) / one.deviation, 2);
  return cost;
}

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
    Eigen::Map<VectorXd> here(residuals, num_residuals());
    here = at_numbers(at);
    if (!here.allFinite() || is_cancelled()) return false;
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> jacobian(
        jacobians[0], num_residuals(), columns);
    for (Index column = 0; column < columns; ++column) {
      const DriveRange& one = numbers_[static_cast<std::size_t>(column)];
      VectorXd moved = at;
      const double step = at(column) + one.step > one.high ? -one.step : one.step;
      moved(column) += step;
      jacobian.col(column) = (at_numbers(moved) - here) / step;
    }
    return jacobian.allFinite();
  }

 private:
  VectorXd at_numbers(const VectorXd& at) const {
    TableDrive drive = start_;
    VectorXd all(num_residuals());
    for (Index k = 0; k < at.size(); ++k) {
      const DriveRange& one = numbers_[static_cast<std::size_t>(k)];
      set_number(drive, one.which, at(k));
      all(rows_ + k) = (at(k) - one.middle) / one.deviation;
    }
    const Eigen::ArrayXd left = remainder_.of(drive).array() / scale_;
    all.head(rows_) = left.sign() * ((kDegrees + 1.0) * (left.square() / kDegrees).log1p()).sqrt();
    return all;
  }

  const TableDrive& start_;
  const std::vector<DriveRange>& numbers_;
  const Remainder& remainder_;
  Index rows_;
  double scale_;
};

/// At the scale of the noise at its start.
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

/// Where else the fit may stand as well. At a reversal the table loses the gap and twice what its friction bends the
/// spring: more of one beside less of the other loses as much. Where it slides on, its friction alone is in doubt. The
/// drive itself is among them.
std::vector<TableDrive> alike_at_reversals(const TableDrive& drive) {
  const double loss = drive.gap + 2.0 * drive.lag * drive.deceleration;
  std::vector<TableDrive> alike;
  for (const double lag : {0.8, 0.9, 1.0, 1.1, 1.25})
    for (const double part : {0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95}) {
      TableDrive one = drive;
      one.lag *= lag;
      one.gap = part * loss;
      one.deceleration = 0.5 * (1.0 - part) * loss / one.lag;
      alike.push_back(one);
    }
  for (const double friction : {0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 2.8}) {
    alike.push_back(drive);
    alike.back().deceleration *= friction;
  }
  return alike;
}

}  // namespace

TableDrive fit_drive(std::vector<TableDrive> starts, const TableRows& rows, const Evidence& evidence,
                     const MatrixXd& others, double correlation, double deceleration) {
  const std::vector<DriveRange> numbers = free_numbers(starts.front(), deceleration);
  const Remainder remainder(rows, evidence, others, correlation);
  const bool is_new = starts.size() > 1;
  double least = HUGE_VAL;
  const auto price = [&](int iterations) {
    std::vector<std::pair<double, std::size_t>> costs(starts.size());
    for_each_in_parallel(starts.size(), [&](std::size_t k) {
      if (iterations > 0) starts[k] = settled(starts[k], numbers, remainder, rows.size(), iterations);
      costs[k] = {remainder.cost_of(remainder.of(starts[k])) + prior_cost(starts[k], numbers), k};
    });
    std::ranges::sort(costs);
    std::vector<TableDrive> ordered;
    for (const auto& [cost, k] : costs) ordered.push_back(starts[k]);
    starts = std::move(ordered);
    least = costs.front().first;
  };
  price(0);
  // Between sizes that lose as much at a reversal lie worse ones: the best of each gap, or of each spring, goes on.
  std::vector<TableDrive> best_of_each;
  for (const TableDrive& start : starts)
    if (std::ranges::none_of(best_of_each, [&](const TableDrive& kept) {
          return start.gap > 0.0 ? kept.gap == start.gap : kept.lag == start.lag;
        }))
      best_of_each.push_back(start);
  starts = std::move(best_of_each);
  constexpr std::pair<std::size_t, int> kRounds[] = {{6, 6}, {4, 12}, {2, 20}};  // starts that go on, iterations
  const auto go_on = [&] {
    for (const auto& [kept, iterations] : kRounds) {
      starts.resize(std::min(kept, starts.size()));
      price(iterations);
    }
  };
  go_on();
  constexpr int kRidges = 2;
  for (int ridge = 0; ridge < kRidges && is_new && starts.front().gap > 0.0 && starts.front().lag > 0.0; ++ridge) {
    const double before = least;
    starts = alike_at_reversals(starts.front());
    price(0);
    go_on();
    if (!(least < before - 1.0)) break;
  }
  return starts.front();
}

}  // namespace host
