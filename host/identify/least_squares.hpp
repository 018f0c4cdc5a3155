// Linear least squares in one pass over the rows, with intervals that are valid for correlated residuals.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace host {

/// Two-sided 95 % quantile of Student's t for `degrees` >= 1 degrees of freedom.
double student_t_95(double degrees);

/// Result of a regression.
struct Regression {
  Eigen::VectorXd parameters;
  Eigen::MatrixXd covariance;      ///< covariance of the parameters, by block sums (see BlockedRegression)
  double condition_number = 0.0;   ///< of the regressors with columns of unit length; infinite if singular
  double t_quantile = 0.0;         ///< half-width of a 95 % interval in standard deviations
  double relative_residual = 0.0;  ///< norm(y - Phi parameters) / norm(y)
  std::size_t rows = 0;
};

/// Normal equations of one block of consecutive rows.
struct NormalEquations {
  Eigen::MatrixXd moment;      ///< Phi'Phi
  Eigen::VectorXd projection;  ///< Phi'y
  double square = 0.0;         ///< y'y
};

/// Solves the sum of the blocks for `unknowns` parameters. Covariance: sandwich estimate with the blocks as independent
/// clusters (batch means). It is valid for residuals of any spectrum and variance whose correlation is shorter than a
/// block. Intervals use Student's t with (blocks - parameters) degrees of freedom. Parameters are NaN if the equations
/// are singular, for example if there is no row.
Regression solve_blocks(const std::vector<NormalEquations>& blocks, Eigen::Index unknowns, std::size_t rows);

/// Collects rows in blocks. The score of a block (sum of regressor times residual) follows from its sums once the
/// parameters are known, so one pass over the data gives estimate and intervals.
template <int P>
class BlockedRegression {
 public:
  using Row = Eigen::Matrix<double, P, 1>;

  explicit BlockedRegression(std::size_t rows_per_block) : rows_per_block_(rows_per_block) {}

  void add(const Row& phi, double y) {
    moment_.noalias() += phi * phi.transpose();
    projection_.noalias() += phi * y;
    square_ += y * y;
    ++rows_;
    if (++rows_in_block_ == rows_per_block_) end_block();
  }

  /// The same for rows [begin, end), faster: `fill(k, row)` writes phi and, as the last of P + 1 numbers, y. About a
  /// hundred rows at a time are stored in columns, whose inner products the processor can vectorise.
  template <typename Fill>
  void add_rows(std::size_t begin, std::size_t end, const Fill& fill) {
    constexpr std::size_t kRows = 128;  // 5 kB for P = 4, which fits in the L1 cache
    Eigen::Matrix<double, kRows, P + 1> rows;
    while (begin < end) {
      const std::size_t count = std::min({kRows, end - begin, rows_per_block_ - rows_in_block_});
      for (std::size_t k = 0; k < count; ++k) fill(begin + k, rows.row(static_cast<Eigen::Index>(k)));
      rows.bottomRows(static_cast<Eigen::Index>(kRows - count)).setZero();
      for (int c = 0; c < P; ++c) {
        for (int other = 0; other < c; ++other) {
          moment_(c, other) += rows.col(c).dot(rows.col(other));
          moment_(other, c) = moment_(c, other);
        }
        moment_(c, c) += rows.col(c).squaredNorm();
        projection_(c) += rows.col(c).dot(rows.col(P));
      }
      square_ += rows.col(P).squaredNorm();
      rows_ += count;
      rows_in_block_ += count;
      if (rows_in_block_ == rows_per_block_) end_block();
      begin += count;
    }
  }

  /// Must be called between records, because their rows are not consecutive.
  void end_block() {
    if (rows_in_block_ == 0) return;
    blocks_.push_back({moment_, projection_, square_});
    moment_.setZero();
    projection_.setZero();
    square_ = 0.0;
    rows_in_block_ = 0;
  }

  Regression solve() {
    end_block();
    return solve_blocks(blocks_, P, rows_);
  }

 private:
  std::size_t rows_per_block_;
  std::size_t rows_in_block_ = 0;
  std::size_t rows_ = 0;
  Eigen::Matrix<double, P, P> moment_ = Eigen::Matrix<double, P, P>::Zero();
  Row projection_ = Row::Zero();
  double square_ = 0.0;
  std::vector<NormalEquations> blocks_;
};

/// Number of rows per block, for this many rows in total: at least 0.1 s, so that a block is longer than the
/// correlation of the residual; at most a fiftieth of the data, so that there are enough blocks for a variance.
std::size_t rows_per_block(std::size_t rows, double row_period_s);

}  // namespace host
