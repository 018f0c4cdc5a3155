// Wrappers of Eigen's solvers, compiled once, because each instance in each file takes seconds to compile.
#pragma once

#include <Eigen/Core>
#include <functional>

namespace host {

/// Eigenvalues of a square matrix, in Eigen's order.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix);

/// Eigenvalues of a symmetric matrix, ascending, and the unit eigenvectors as columns.
struct SymmetricSpectrum {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
SymmetricSpectrum symmetric_spectrum(const Eigen::MatrixXd& matrix);

/// Singular values, descending, and right singular vectors as columns, of a matrix with at least as many rows as
/// columns.
struct RightSingular {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
RightSingular right_singular(const Eigen::MatrixXd& matrix);

/// Orthonormal columns that span those of the matrix, by QR with column pivoting; as many as its rank.
Eigen::MatrixXd orthonormal_basis(const Eigen::MatrixXd& matrix);

/// Least-squares coefficients of the columns for `values`, by QR with column pivoting.
Eigen::VectorXd least_squares_solution(const Eigen::MatrixXd& columns, const Eigen::VectorXd& values);
Eigen::MatrixXd least_squares_solution(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& values);

/// The least-squares coefficients of smallest norm for `values`, by complete orthogonal decomposition. The
/// pseudo-inverse is the solution for unit values.
Eigen::VectorXd least_norm_solution(const Eigen::MatrixXd& columns, const Eigen::VectorXd& values);
/// The same for several sets of values with the same columns.
std::function<Eigen::VectorXd(const Eigen::VectorXd&)> least_norm_solver(const Eigen::MatrixXd& columns);
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& matrix);

/// Solution of a symmetric, positive or negative semidefinite system, by LDL^T with pivoting.
Eigen::VectorXd symmetric_solution(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& values);
Eigen::MatrixXd symmetric_solution(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& values);
Eigen::MatrixXd symmetric_inverse(const Eigen::MatrixXd& matrix);
/// The same for a fixed size, used for every sample.
Eigen::Matrix3d symmetric_solution_of_3(const Eigen::Matrix3d& matrix, const Eigen::Matrix3d& values);

/// Solution of a square, invertible system, by LU with partial pivoting.
Eigen::MatrixXd square_solution(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& values);
Eigen::MatrixXd square_inverse(const Eigen::MatrixXd& matrix);

/// Exponential of a square matrix.
Eigen::MatrixXd exponential(const Eigen::MatrixXd& matrix);

/// Inner products of the columns, `columns`^T `columns`.
Eigen::MatrixXd gram(const Eigen::MatrixXd& columns);

}  // namespace host
