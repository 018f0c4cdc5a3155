// Builds smooth functions over coordinates as the columns of a memory.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "host/infer/evidence.hpp"

namespace host {

/// Knots from `low` to `high` (> low) with equal steps, or with equal ratios (low > 0). `count` >= 2.
std::vector<double> even_knots(double low, double high, int count);
std::vector<double> knots_by_factor(double low, double high, int count);

/// Value of each knot's hat function in each row: piecewise linear functions that sum to 1 and are constant beyond the
/// knots. Needs at least two knots, ascending.
Eigen::MatrixXd hats(const Eigen::VectorXd& at, const std::vector<double>& knots);

/// The part of the columns that the other columns do not explain. Without this step, a memory could explain the same as
/// the model and mask it: M. Plumlee, "Bayesian calibration of inexact computer models", JASA 112 (2017), eq. (5).
Eigen::MatrixXd beside(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& others);

class MemoryBuilder {
 public:
  /// Adds a group, without columns that are zero.
  void add(std::string coordinate, const Eigen::MatrixXd& columns);
  /// `usual`: typical size of the factors, in the unit of y.
  Memory take(double usual);

 private:
  Memory memory_;
};

}  // namespace host
