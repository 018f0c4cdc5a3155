#include "host/dense_solutions.hpp"

#include <Eigen/Dense>
#include <unsupported/Eigen/MatrixFunctions>

#include "host/inner_products_kernel.hpp"

namespace host {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Eigen::VectorXcd eigenvalues(const MatrixXd& matrix) { return matrix.eigenvalues(); }

SymmetricSpectrum symmetric_spectrum(const MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> found(matrix);
  return {found.eigenvalues(), found.eigenvectors()};
}

RightSingular right_singular(const MatrixXd& matrix) {
  const Eigen::JacobiSVD<MatrixXd> found(matrix, Eigen::ComputeThinV);
  return {found.singularValues(), found.matrixV()};
}

MatrixXd orthonormal_basis(const MatrixXd& matrix) {
  const auto parts = matrix.colPivHouseholderQr();
  return parts.householderQ() * MatrixXd::Identity(matrix.rows(), parts.rank());
}

VectorXd least_squares_solution(const MatrixXd& columns, const VectorXd& values) {
  return columns.colPivHouseholderQr().solve(values);
}

MatrixXd least_squares_solution(const MatrixXd& columns, const MatrixXd& values) {
  return columns.colPivHouseholderQr().solve(values);
}

std::function<VectorXd(const VectorXd&)> least_norm_solver(const MatrixXd& columns) {
  return [parts = columns.completeOrthogonalDecomposition()](const VectorXd& values) -> VectorXd {
    return parts.solve(values);
  };
}

VectorXd least_norm_solution(const MatrixXd& columns, const VectorXd& values) {
  return least_norm_solver(columns)(values);
}

MatrixXd pseudo_inverse(const MatrixXd& matrix) { return matrix.completeOrthogonalDecomposition().pseudoInverse(); }

VectorXd symmetric_solution(const MatrixXd& matrix, const VectorXd& values) { return matrix.ldlt().solve(values); }

MatrixXd symmetric_solution(const MatrixXd& matrix, const MatrixXd& values) { return matrix.ldlt().solve(values); }

MatrixXd symmetric_inverse(const MatrixXd& matrix) {
  return symmetric_solution(matrix, MatrixXd(MatrixXd::Identity(matrix.rows(), matrix.cols())));
}

Eigen::Matrix3d symmetric_solution_of_3(const Eigen::Matrix3d& matrix, const Eigen::Matrix3d& values) {
  return matrix.ldlt().solve(values);
}

MatrixXd square_solution(const MatrixXd& matrix, const MatrixXd& values) { return matrix.partialPivLu().solve(values); }

MatrixXd square_inverse(const MatrixXd& matrix) { return matrix.inverse(); }

MatrixXd exponential(const MatrixXd& matrix) { return matrix.exp(); }

struct Avx;
struct AnyProcessor;
extern template void inner_products<Avx>(const double*, std::size_t, std::size_t, double*);

MatrixXd gram(const MatrixXd& columns) {
#if defined(__x86_64__)
  static const bool has_avx = __builtin_cpu_supports("avx") != 0;
  const auto compute = has_avx ? &inner_products<Avx> : &inner_products<AnyProcessor>;
#else
  const auto compute = &inner_products<AnyProcessor>;
#endif
  MatrixXd products(columns.cols(), columns.cols());
  compute(columns.data(), static_cast<std::size_t>(columns.rows()), static_cast<std::size_t>(columns.cols()),
          products.data());
  return products;
}

}  // namespace host
