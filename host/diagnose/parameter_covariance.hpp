// How well records determine the free parameters of a model together.
#pragma once

#include <Eigen/Core>

#include "host/compare/comparison.hpp"
#include "host/diagnose/parameter_vector.hpp"

namespace host {

struct ParameterCovariance {
  ParameterVector vector;
  Eigen::VectorXd values;  ///< of the parameters, in their own units
  Eigen::MatrixXd matrix;  ///< of the values; empty if the model diverges
};

/// At the model's present values; cluster-robust, since residuals are correlated within a window.
ParameterCovariance covariance_of(const sim::DriveDescription& model, const RecordSet& training);

}  // namespace host
