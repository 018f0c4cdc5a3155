// Fit of all parameters of a model together to records, by the prediction error over short windows.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <vector>

#include "host/compare/comparison.hpp"
#include "host/fit/parameter_vector.hpp"

namespace host {

struct FitOptions {
  int most_iterations = 25;
  double least_gain = 1e-4;  ///< a step is the last if it lowers the squared error by less than this (relative)
  Freedom freedom = Freedom::everything;
  /// Number of integrator steps after which a fit ends with its present values. It is not a time limit, so that every
  /// computer gives the same result.
  double most_steps = HUGE_VAL;
};

/// For an effect on a base that was fitted without it, and would suppress it: its size first, alone. A spectrum, for
/// example, gives the period of a ripple correctly, but smoothing reduces its amplitude.
inline constexpr FitOptions kOwnSize{.most_iterations = 5, .least_gain = 1e-2, .freedom = Freedom::last_effect};

struct FitResult {
  sim::DriveDescription model;
  double robust = 0.0;  ///< SetError::robust of the training set at the solution
  int iterations = 0;
  double steps = 0.0;      ///< integrator steps used
  bool cut_short = false;  ///< ended because all steps were used
};

/// Levenberg-Marquardt (Ceres) within the catalogue's bounds, from the model's present values.
FitResult fit_model(const sim::DriveDescription& start, const RecordSet& training, const FitOptions& options = {});

/// Change of the residuals of a set for a small change of each parameter.
struct Linearisation {
  Eigen::VectorXd residuals;  ///< as residuals_of() gives them, followed by those of the priors
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> slopes;  ///< per FreeParameter::scale
};

/// Linearises at the model's present values. Empty if the model diverges.
Linearisation linearise(const sim::DriveDescription& model, const ParameterVector& vector, const RecordSet& set);

/// Estimate of one fitted parameter.
struct ParameterEstimate {
  std::string name;  ///< "cogging.cosine"
  double value;
  double deviation;             ///< standard error
  bool determined;              ///< false if the interval is as wide as the value or the correlation is nearly 1
  std::string correlated_with;  ///< the partner of the strongest correlation above 0.95; may be empty
  double correlation = 0.0;
};

/// Estimates with standard errors that allow for correlated residuals within a window (cluster-robust). Writes them
/// into the model as 95 % intervals.
std::vector<ParameterEstimate> estimate_intervals(sim::DriveDescription& model, const RecordSet& training);

}  // namespace host
