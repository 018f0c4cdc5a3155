// Converts a solver's sparse matrix to a dense one.
#pragma once

#include <ceres/crs_matrix.h>

#include <Eigen/Core>

namespace host {

inline Eigen::MatrixXd dense_matrix(const ceres::CRSMatrix& sparse) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(sparse.num_rows, sparse.num_cols);
  for (int row = 0; row < sparse.num_rows; ++row)
    for (int at = sparse.rows[static_cast<std::size_t>(row)]; at < sparse.rows[static_cast<std::size_t>(row) + 1]; ++at)
      dense(row, sparse.cols[static_cast<std::size_t>(at)]) = sparse.values[static_cast<std::size_t>(at)];
  return dense;
}

}  // namespace host
