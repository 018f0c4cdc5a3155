// Least squares of the effort on the columns of effects, as far as physics leaves each factor room.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "host/compare/comparison.hpp"
#include "host/effort/effort_rows.hpp"
#include "host/effort/effort_terms.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// A model whose parameters came from the regression.
struct ScreenedModel {
  std::vector<std::string> kinds;  ///< beyond the base, in the order in which they were chosen
  sim::DriveDescription model;
  std::string words;  ///< of the last kind: "orders 72, 18 of 6.283 mm"; may be empty
  /// RMS residual over RMS acting effort of the rows; 1 is no better than no model.
  double train = 1.0, validate = 1.0;
  double probability = 0.0;  ///< of the last kind, or of its group, among all that may follow and nothing
  double confidence = 0.0;   ///< of the last kind against nothing more
  std::size_t factors = 0;
  Eigen::VectorXd residual;  ///< of every row, Nm or N
};

/// Regression of the effort of the training rows, or of a part of it. Keeps references to model, rows and effort.
class EffortRegression {
 public:
  EffortRegression(const sim::DriveDescription& model, const EffortRows& rows)
      : EffortRegression(model, rows, rows.effort) {}
  /// `effort`: what is left to explain, Nm or N, one element a row.
  EffortRegression(const sim::DriveDescription& model, const EffortRows& rows, const Eigen::VectorXd& effort);

  /// How much each row counts, 0 to 1: less where the residual's Student distribution takes it for an outlier.
  void weigh(const Eigen::VectorXd& weights);

  /// Fits the base and the further terms; false where a further term's factor has no room within physics.
  bool fit(const std::vector<EffortTerm>& base, const std::vector<const EffortTerm*>& further, ScreenedModel& out,
           std::vector<std::string>* held = nullptr) const;

  /// That the judging rows' error falls, by a bootstrap over their blocks.
  double confidence(const ScreenedModel& before, const ScreenedModel& after) const;

 private:
  /// What is known of a factor before the fit.
  struct Prior {
    double value = 0.0;
    double deviation = 0.0;  ///< 0: nothing is known
    bool held = false;
  };

  Prior belief_of(std::size_t index, const std::vector<EffortTerm>& base) const;
  Eigen::VectorXd solve(const Eigen::MatrixXd& moments, const Eigen::VectorXd& projection,
                        const std::vector<Prior>& beliefs, const std::vector<bool>& fixed, double variance) const;
  /// Variance of a row's residual as if rows were independent: rows of a block are alike, and count for fewer.
  double effective_variance(const Eigen::MatrixXd& phi, const Eigen::VectorXd& theta) const;
  /// `acting`: EffortTerm::acting of all terms together.
  void measure(ScreenedModel& model, double acting) const;
  SetError by_block(const Eigen::VectorXd& residual) const;

  const sim::DriveDescription& model_;
  const EffortRows& rows_;
  const Eigen::VectorXd& effort_;          ///< what is left to explain, one element a row
  Eigen::VectorXd train_;                  ///< 0 for rows that judge, else the weight, 0 to 1
  double effort_train_, effort_validate_;  ///< RMS of all that the motor gave
};

}  // namespace host
