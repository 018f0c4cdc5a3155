// Joint fit of all parameters of a model to records, by prediction error over short windows.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <vector>

#include "host/compare/comparison.hpp"
#include "host/diagnose/parameter_vector.hpp"

namespace host {

struct FitOptions {
  int most_iterations = 25;
  double least_gain = 1e-4;  ///< relative gain of the squared error under which a step is the last one
  Freedom freedom = Freedom::everything;
  /// Steps of the integrator after which a fit ends with what it has: no clock, so that every machine finds the same.
  double most_steps = HUGE_VAL;
};

struct FitResult {
  sim::DriveDescription model;
  double robust = 0.0;  ///< SetError::robust of the training set at the solution
  int iterations = 0;
  double steps = 0.0;      ///< of the integrator
  bool cut_short = false;  ///< ended because they were used up
};

/// Levenberg-Marquardt (Ceres) within the catalogue's bounds, from the model's present values.
FitResult fit_model(const sim::DriveDescription& start, const RecordSet& training, const FitOptions& options = {});

/// What a small change of each parameter does to the residuals of a set.
struct Linearisation {
  Eigen::VectorXd residuals;  ///< as residuals_of() gives them, and below them what is believed
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> slopes;  ///< per scale of each parameter
};

/// At the model's present values. Empty if the model diverges.
Linearisation linearise(const sim::DriveDescription& model, const ParameterVector& vector, const RecordSet& set);

/// What the data say of one fitted parameter.
struct ParameterEstimate {
  std::string name;  ///< "cogging.cosine"
  double value;
  double deviation;             ///< standard error
  bool determined;              ///< false where the interval is as wide as the value or the correlation nearly complete
  std::string correlated_with;  ///< the partner of the strongest correlation above 0.95; may be empty
  double correlation = 0.0;
};

/// Estimates with standard errors that allow for residuals being alike within a window (cluster-robust), written into
/// the model as 95 % intervals.
std::vector<ParameterEstimate> estimate_intervals(sim::DriveDescription& model, const RecordSet& training);

}  // namespace host
