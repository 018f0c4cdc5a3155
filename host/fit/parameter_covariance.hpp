// Covariance of the free parameters of a model fitted to records.
#pragma once

#include <Eigen/Core>

#include "host/compare/comparison.hpp"
#include "host/fit/parameter_vector.hpp"

namespace host {

struct ParameterCovariance {
  ParameterVector vector;
  Eigen::VectorXd values;  ///< values of the parameters, in their own units
  Eigen::MatrixXd matrix;  ///< covariance of the values; empty if the model diverges or is held
};

/// Covariance at the model's present values; cluster-robust, because residuals are correlated within a window.
ParameterCovariance covariance_of(const sim::DriveDescription& model, const RecordSet& training);

}  // namespace host
