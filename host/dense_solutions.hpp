// What Eigen solves through much code, compiled once: an instance for each size and file takes seconds.
#pragma once

#include <Eigen/Core>

namespace host {

/// Of a square matrix, in the order in which Eigen finds them.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix);

/// Coefficients of the columns that come closest to `values`, by QR with column pivoting.
Eigen::VectorXd least_squares_solution(const Eigen::MatrixXd& columns, const Eigen::VectorXd& values);

}  // namespace host
