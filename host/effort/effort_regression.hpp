// Least squares of torque or force on the columns of effects, with physical bounds of the factors.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "host/effort/effort_rows.hpp"
#include "host/effort/effort_terms.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// A model with parameters from the regression.
struct ScreenedModel {
  std::vector<std::string> kinds;  ///< effects beyond the base, in the order of their choice
  sim::DriveDescription model;
  std::string words;  ///< details of the last kind: "orders 72, 18 of 6.283 mm"; may be empty
  /// RMS residual over RMS torque or force of the rows; 1 if the model explains nothing.
  double train = 1.0, validate = 1.0;
  double probability = 0.0;  ///< of the last kind or its group, compared with all candidates and "nothing"
  double log_odds = 0.0;     ///< of the last kind over no further effect, nats
  double confidence = 0.0;   ///< that the last kind is better than no further effect
  std::size_t factors = 0;
  Eigen::VectorXd residual;  ///< of every row, Nm or N
};

/// Regression of the torque or force of the training rows, or of a part of it. Keeps references to model, rows and
/// effort.
class EffortRegression {
 public:
  EffortRegression(const sim::DriveDescription& model, const EffortRows& rows)
      : EffortRegression(model, rows, rows.effort) {}
  /// `effort`: residual to explain, Nm or N, one element per row.
  EffortRegression(const sim::DriveDescription& model, const EffortRows& rows, const Eigen::VectorXd& effort);

  /// Weight of each row, 0 to 1; outliers have smaller weights (Student distribution of the residual).
  void weigh(const Eigen::VectorXd& weights);

  /// Fits the base and the further terms; false if a factor of a further term exceeds its physical bounds.
  bool fit(const std::vector<EffortTerm>& base, const std::vector<const EffortTerm*>& further, ScreenedModel& out,
           std::vector<std::string>* held = nullptr) const;

  /// Probability that the validation error decreases, by a block bootstrap.
  double confidence(const ScreenedModel& before, const ScreenedModel& after) const;

 private:
  /// Prior of a factor.
  struct Prior {
    double value = 0.0;
    double deviation = 0.0;  ///< standard deviation; 0 if there is no prior
    bool held = false;
  };

  Prior belief_of(std::size_t index, const std::vector<EffortTerm>& base) const;
  Eigen::VectorXd solve(const Eigen::MatrixXd& moments, const Eigen::VectorXd& projection,
                        const std::vector<Prior>& beliefs, const std::vector<bool>& fixed, double variance) const;
  /// Variance of a row's residual if the rows were independent. It allows for the correlation of rows in a block.
  double effective_variance(const Eigen::MatrixXd& phi, const Eigen::VectorXd& theta) const;
  /// `acting`: product of EffortTerm::acting of all terms.
  void measure(ScreenedModel& model, double acting) const;
  std::vector<double> squares_by_block(const Eigen::VectorXd& residual) const;

  const sim::DriveDescription& model_;
  const EffortRows& rows_;
  const Eigen::VectorXd& effort_;          ///< residual to explain, one element per row
  Eigen::VectorXd train_;                  ///< 0 for validation rows, else the weight, 0 to 1
  double effort_train_, effort_validate_;  ///< RMS of the motor's torque or force
};

}  // namespace host
