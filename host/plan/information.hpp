// Information of a piece of a run about a rival: its squared error, and how the error changes when the rival is
// refitted.
#pragma once

#include <Eigen/Core>

#include "host/plan/rival.hpp"

namespace host {

/// chi^2 of a model near its present parameters: square + 2 slope' d + d' curvature d for a change d of the parameters
/// in units of their scales. The values of independent records are added.
struct Information {
  Eigen::MatrixXd curvature;
  Eigen::VectorXd slope;
  double square = 0.0;

  Information& operator+=(const Information& other);
  Information& operator*=(double factor);

  /// The smallest chi^2 for any change of the parameters: that of a rival refitted as far as prior knowledge allows
  /// (T-optimality with a linearised inner fit; with the curvature of the training records this is the quadratic form
  /// with the covariance of the parameters by Buzzi-Ferraris and Forzatti).
  double least() const;
};

/// Information from motor and table on a set, at the model's parameters. Empty if the model diverges.
Information information_of(const sim::DriveDescription& model, const RecordSet& set);

/// Information from the motor alone.
Information information_of_motion(const sim::DriveDescription& model, const RecordSet& set);

/// Information from x2 - x alone. For each window: its mean squared error over the square of the steps of both sensors,
/// without the offsets of the records. Empty if the record has no scale.
Information information_of_table(const sim::DriveDescription& model, const RecordSet& set);

/// Number of windows with a scale: the observations of information_of_table().
std::size_t table_windows(const RecordSet& set);

/// Integrator steps of information_of().
double steps_of_information(const sim::DriveDescription& model, const RecordSet& set);

}  // namespace host
