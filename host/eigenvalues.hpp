// Eigenvalues of small matrices, compiled once: an instance for each size and file takes half a minute.
#pragma once

#include <Eigen/Core>

namespace host {

/// Of a square matrix, in the order in which Eigen finds them.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix);

}  // namespace host
