#include "host/identify/least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/dense_solutions.hpp"

namespace host {

double student_t_95(double degrees) {
  // Cornish-Fisher expansion about the normal quantile; Abramowitz & Stegun 26.7.5. It has too few terms below 3
  // degrees of freedom, so exact values (26.7 table) are used there.
  if (degrees < 1.5) return 12.7062;
  if (degrees < 2.5) return 4.3027;
  constexpr double z = 1.959963984540054;
  const double z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
  const double n = degrees;
  return z + (z3 + z) / (4.0 * n) + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * n * n) +
         (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * n * n * n);
}

Regression solve_blocks(const std::vector<NormalEquations>& blocks, Eigen::Index unknowns, std::size_t rows) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Regression result;
  result.rows = rows;
  result.condition_number = infinity;
  const Eigen::Index p = unknowns;
  result.parameters = Eigen::VectorXd::Constant(p, std::numeric_limits<double>::quiet_NaN());
  result.covariance = Eigen::MatrixXd::Constant(p, p, infinity);
  if (blocks.empty()) return result;

  Eigen::MatrixXd moment = Eigen::MatrixXd::Zero(p, p);
  Eigen::VectorXd projection = Eigen::VectorXd::Zero(p);
  double square = 0.0;
  for (const NormalEquations& block : blocks) {
    moment += block.moment;
    projection += block.projection;
    square += block.square;
  }
  const Eigen::VectorXd scale = moment.diagonal().cwiseSqrt();
  if (!(scale.minCoeff() > 0.0) || !moment.allFinite()) return result;
  const Eigen::VectorXd unscale = scale.cwiseInverse();
  const Eigen::MatrixXd scaled = unscale.asDiagonal() * moment * unscale.asDiagonal();
  const Eigen::VectorXd spectrum = symmetric_spectrum(scaled).values;
  const double smallest = spectrum(0), largest = spectrum(p - 1);
  if (smallest <= largest * 1e-15) return result;
  result.condition_number = std::sqrt(largest / smallest);

  const Eigen::MatrixXd inverse = unscale.asDiagonal() * symmetric_inverse(scaled) * unscale.asDiagonal();
  result.parameters = inverse * projection;
  result.relative_residual = std::sqrt(std::max(0.0, 1.0 - result.parameters.dot(projection) / square));
  Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(p, p);
  for (const NormalEquations& block : blocks) {
    const Eigen::VectorXd score = block.projection - block.moment * result.parameters;
    meat += score * score.transpose();
  }
  const double count = static_cast<double>(blocks.size());
  const double degrees = std::max(1.0, count - static_cast<double>(p));
  result.covariance = count / degrees * inverse * meat * inverse;
  result.t_quantile = student_t_95(degrees);
  return result;
}

std::size_t rows_per_block(std::size_t rows, double row_period_s) {
  constexpr double kShortest_s = 0.1;
  constexpr std::size_t kBlocks = 50;
  const auto shortest = static_cast<std::size_t>(std::ceil(kShortest_s / row_period_s));
  return std::max({std::size_t{1}, shortest, rows / kBlocks});
}

}  // namespace host
