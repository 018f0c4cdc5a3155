#include "host/eigenvalues.hpp"

#include <Eigen/Eigenvalues>

namespace host {

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix) { return matrix.eigenvalues(); }

}  // namespace host
