// Information of a piece of a run about a rival: its squared error, and its change when the rival is re-fitted.
#pragma once

#include <Eigen/Core>

#include "host/plan/rival.hpp"

namespace host {

/// chi^2 of a model about its present parameters: square + 2 slope' d + d' curvature d for a change d of the parameters
/// in units of their scales. Those of independent records add up.
struct Information {
  Eigen::MatrixXd curvature;
  Eigen::VectorXd slope;
  double square = 0.0;

  Information& operator+=(const Information& other);

  /// The smallest chi^2 that any change of the parameters reaches: what is left where the rival has bent as far as what
  /// is known of it allows (T-optimality with the inner fit linearised; with the curvature of the training records
  /// this is the quadratic form with the parameters' covariance of Buzzi-Ferraris and Forzatti).
  double least() const;
};

/// About the model's parameters, on a set. Nothing where the model runs away.
Information information_of(const sim::DriveDescription& model, const RecordSet& set);

/// Steps of the integrator that information_of() takes.
double steps_of_information(const sim::DriveDescription& model, const RecordSet& set);

}  // namespace host
