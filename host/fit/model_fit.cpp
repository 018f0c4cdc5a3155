#include "host/fit/model_fit.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "host/cancellation.hpp"
#include "host/fit/parameter_covariance.hpp"
#include "host/statistics.hpp"

namespace host {

namespace {

/// Difference step of the Jacobian, relative to a parameter's scale: far above rounding errors, small enough that
/// curvature does not matter.
constexpr double kDifferenceStep = 1e-4;

/// The same for a drive with impacts, whose error is not smooth on a finer scale. A fit over this difference comes near
/// the optimum. It keeps the slopes of all parameters but those of the last effect until its squared error is
/// kKeptUntil of what it was (a chord method). A second fit over the finer difference follows, with all slopes.
constexpr double kAcrossImpacts = 1e-2, kKeptUntil = 0.5;

std::vector<double> difference_steps(const sim::DriveDescription& model) {
  const sim::Drive drive(model);
  if (drive.has_second_mass() && drive.second_mass->gap > 0.0) return {kAcrossImpacts, kDifferenceStep};
  return {kDifferenceStep};
}

class WindowResiduals : public ceres::CostFunction {
 public:
  WindowResiduals(const sim::DriveDescription& model, const ParameterVector& vector, const RecordSet& set)
      : model_(model), vector_(vector), set_(set), rows_(static_cast<Eigen::Index>(residual_count(set))) {
    // A prior has the weight of one further measurement with this set's error.
    const auto windows = static_cast<double>(std::max<std::size_t>(1, set.used_windows()));
    belief_weight_ = std::sqrt(std::max(1.0, set.common_square / kCommonSquare) / windows);
    for (std::size_t k = 0; k < vector.size(); ++k)
      if (vector.parameters()[k].believed) rows_ += 1;
    set_num_residuals(static_cast<int>(rows_));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(vector.size()));
  }

  /// Parameters are in units of their scales. Returns false once the fit is cancelled.
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const auto columns = static_cast<Eigen::Index>(vector_.size());
    const Eigen::Map<const Eigen::VectorXd> scaled(parameters[0], columns);
    Eigen::Map<Eigen::VectorXd> here(residuals, rows_);
    here = residuals_at(scaled);
    if (!here.allFinite() || is_cancelled()) return false;
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> jacobian(jacobians[0], rows_,
                                                                                                columns);
    Eigen::VectorXd there(rows_);
    const double square = here.squaredNorm();
    const bool keeps = difference_ > kDifferenceStep;
    const bool has_kept = kept_.size() > 0 && square > kKeptUntil * kept_square_;
    if (keeps && !has_kept) kept_square_ = square;
    for (Eigen::Index column = 0; column < columns; ++column) {
      if (is_cancelled()) return false;
      const FreeParameter& free = vector_.parameters()[static_cast<std::size_t>(column)];
      if (has_kept && free.effect + 1 < model_.effects.size()) {
        jacobian.col(column) = kept_.col(column);
        continue;
      }
      // A step down from the upper bound, because a step up would be clamped.
      // The phase of a wave grows with the travel, so its period allows no large step.
      const double size = free.entries.front().first == "period" ? kDifferenceStep : difference_;
      const bool at_top = scaled(column) * free.scale + size * free.scale > free.upper;
      const double step = at_top ? -size : size;
      Eigen::VectorXd moved = scaled;
      moved(column) += step;
      evaluate(moved, there.data());
      jacobian.col(column) = (there - here) / step;
    }
    if (keeps && !has_kept) kept_ = jacobian;
    return jacobian.allFinite();
  }

  double steps() const { return steps_; }

  /// The difference step from now on.
  void differ_by(double step) {
    difference_ = step;
    kept_.resize(0, 0);
  }

 private:
  /// The residuals here. Ceres asks for those of one point up to three times in a row: in the line search, for the new
  /// cost, and with the slopes.
  const Eigen::VectorXd& residuals_at(const Eigen::VectorXd& scaled) const {
    if (point_.size() != scaled.size() || point_ != scaled) {
      point_ = scaled;
      at_point_.resize(rows_);
      evaluate(scaled, at_point_.data());
    }
    return at_point_;
  }

  void evaluate(const Eigen::VectorXd& scaled, double* out) const {
    sim::DriveDescription model = model_;
    Eigen::VectorXd values(scaled.size());
    for (Eigen::Index k = 0; k < scaled.size(); ++k)
      values(k) = scaled(k) * vector_.parameters()[static_cast<std::size_t>(k)].scale;
    vector_.write(values, model);
    const sim::Drive drive(model);
    steps_ += steps_of(drive, set_);
    residuals_of(drive, set_, out);
    auto row = rows_;
    for (std::size_t k = vector_.size(); k-- > 0;) {
      const std::optional<sim::Belief>& belief = vector_.parameters()[k].believed;
      if (belief)
        out[--row] = belief_weight_ * (values(static_cast<Eigen::Index>(k)) - belief->value) / belief->deviation;
    }
  }

  const sim::DriveDescription& model_;
  const ParameterVector& vector_;
  const RecordSet& set_;
  Eigen::Index rows_;
  double belief_weight_ = 0.0;
  double difference_ = kDifferenceStep;
  mutable Eigen::MatrixXd kept_ = {};  ///< slopes, and the squared error at which they were computed
  mutable double kept_square_ = 0.0;
  mutable Eigen::VectorXd point_ = {}, at_point_ = {};  ///< the last point, and its residuals
  mutable double steps_ = 0.0;
};

class Budget : public ceres::IterationCallback {
 public:
  Budget(const WindowResiduals& residuals, double most_steps) : residuals_(residuals), most_steps_(most_steps) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    if (is_cancelled()) return ceres::SOLVER_ABORT;
    return spent() ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }
  bool spent() const { return residuals_.steps() >= most_steps_; }

 private:
  const WindowResiduals& residuals_;
  double most_steps_;
};

}  // namespace

FitResult fit_model(const sim::DriveDescription& start, const RecordSet& training, const FitOptions& options) {
  const ParameterVector vector(start, options.freedom);
  if (vector.size() == 0) return {.model = start, .robust = error_of(sim::Drive(start), training).robust, .steps = 0.0};
  const Eigen::VectorXd initial = vector.read(start);
  Eigen::VectorXd scaled(initial.size());
  for (Eigen::Index k = 0; k < scaled.size(); ++k)
    scaled(k) = initial(k) / vector.parameters()[static_cast<std::size_t>(k)].scale;

  ceres::Problem problem;
  auto* residuals = new WindowResiduals(start, vector, training);  // the problem owns it
  problem.AddResidualBlock(residuals, nullptr, scaled.data());
  for (std::size_t k = 0; k < vector.size(); ++k) {
    const FreeParameter& free = vector.parameters()[k];
    problem.SetParameterLowerBound(scaled.data(), static_cast<int>(k), free.lower / free.scale);
    problem.SetParameterUpperBound(scaled.data(), static_cast<int>(k), free.upper / free.scale);
  }
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  solver.max_num_iterations = options.most_iterations;
  solver.function_tolerance = options.least_gain;
  solver.parameter_tolerance = 1e-6;
  solver.line_search_interpolation_type =
      ceres::QUADRATIC;                                 // a cubic would compute all derivatives again at each trial
  solver.max_num_line_search_step_size_iterations = 6;  // a step that fails at a hundredth of its length is rejected
  solver.logging_type = ceres::SILENT;
  solver.num_threads = 1;  // candidates are fitted in parallel
  Budget budget(*residuals, options.most_steps);
  solver.callbacks.push_back(&budget);
  FitResult result;
  result.model = start;
  ceres::Solver::Summary summary;
  for (const double step : difference_steps(start)) {
    if (result.iterations > 0 && budget.spent()) break;
    residuals->differ_by(step);
    ceres::Solve(solver, &problem, &summary);
    throw_if_cancelled();
    result.iterations += static_cast<int>(summary.iterations.size());
  }
  Eigen::VectorXd values(scaled.size());
  for (Eigen::Index k = 0; k < scaled.size(); ++k)
    values(k) = scaled(k) * vector.parameters()[static_cast<std::size_t>(k)].scale;
  vector.write(values, result.model);
  result.robust = summary.IsSolutionUsable() ? std::sqrt(2.0 * summary.final_cost) : HUGE_VAL;
  result.steps = residuals->steps();
  result.cut_short = summary.termination_type == ceres::USER_SUCCESS;
  return result;
}

Linearisation linearise(const sim::DriveDescription& model, const ParameterVector& vector, const RecordSet& set) {
  const WindowResiduals residuals(model, vector, set);
  const auto rows = static_cast<Eigen::Index>(residuals.num_residuals());
  Eigen::VectorXd scaled = vector.read(model);
  for (Eigen::Index k = 0; k < scaled.size(); ++k) scaled(k) /= vector.parameters()[static_cast<std::size_t>(k)].scale;
  Linearisation found{Eigen::VectorXd(rows), {rows, scaled.size()}};
  const double* parameters = scaled.data();
  double* slopes = found.slopes.data();
  const bool runs = residuals.Evaluate(&parameters, found.residuals.data(), &slopes);
  throw_if_cancelled();
  if (!runs) return {};
  return found;
}

std::vector<ParameterEstimate> estimate_intervals(sim::DriveDescription& model, const RecordSet& training) {
  const auto [vector, values, covariance] = covariance_of(model, training);
  std::vector<ParameterEstimate> estimates;
  constexpr double kNearlyOne = 0.95;
  for (Eigen::Index k = 0; k < covariance.rows(); ++k) {
    const FreeParameter& free = vector.parameters()[static_cast<std::size_t>(k)];
    ParameterEstimate estimate{free.name(model), values(k), std::sqrt(std::max(0.0, covariance(k, k))), true, {}, 0.0};
    for (Eigen::Index other = 0; other < covariance.rows(); ++other) {
      const double product = covariance(k, k) * covariance(other, other);
      const double correlation = other == k || product <= 0.0 ? 0.0 : covariance(k, other) / std::sqrt(product);
      if (std::abs(correlation) > std::max(kNearlyOne, std::abs(estimate.correlation))) {
        estimate.correlation = correlation;
        estimate.correlated_with = vector.parameters()[static_cast<std::size_t>(other)].name(model);
      }
    }
    estimate.determined = kNormal95 * estimate.deviation < std::abs(estimate.value) && estimate.deviation > 0.0;
    const double reach = kNormal95 * estimate.deviation;
    for (const auto& [id, sign] : free.entries) {
      const double value = sign * estimate.value;
      model.effects[free.effect].ci95[id] = {value - reach, value + reach};
    }
    estimates.push_back(std::move(estimate));
  }
  return estimates;
}

}  // namespace host
