// Information of a piece of a run about a rival: its squared error, and its change when the rival is re-fitted.
#pragma once

#include <Eigen/Core>

#include "host/plan/rival.hpp"

namespace host {

/// chi^2 of a model near its present parameters: square + 2 slope' d + d' curvature d for a change d of the parameters
/// in units of their scales. The values of independent records add up.
struct Information {
  Eigen::MatrixXd curvature;
  Eigen::VectorXd slope;
  double square = 0.0;

  Information& operator+=(const Information& other);
  Information& operator*=(double factor);

  /// The smallest chi^2 for any change of the parameters: that of a rival re-fitted as far as prior knowledge allows
  /// (T-optimality with a linearised inner fit; with the curvature of the training records this is the quadratic form
  /// with the parameters' covariance of Buzzi-Ferraris and Forzatti).
  double least() const;
};

/// Information from motor and table, at the model's parameters, on a set. Empty if the model diverges.
Information information_of(const sim::DriveDescription& model, const RecordSet& set);

/// Information from the motor alone.
Information information_of_motion(const sim::DriveDescription& model, const RecordSet& set);

/// Of x2 - x alone, where a scale on the table was recorded: over each window its mean square over the square of both
/// sensors' steps, the records' offsets taken out. Empty where none was.
Information information_of_table(const sim::DriveDescription& model, const RecordSet& set);

/// Windows of those records: the observations of information_of_table().
std::size_t table_windows(const RecordSet& set);

/// Integrator steps of information_of().
double steps_of_information(const sim::DriveDescription& model, const RecordSet& set);

}  // namespace host
