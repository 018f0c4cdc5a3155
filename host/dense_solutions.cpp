#include "host/dense_solutions.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace host {

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix) { return matrix.eigenvalues(); }

Eigen::VectorXd least_squares_solution(const Eigen::MatrixXd& columns, const Eigen::VectorXd& values) {
  return columns.colPivHouseholderQr().solve(values);
}

}  // namespace host
