#include "host/effort/effort_regression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "host/compare/chance.hpp"
#include "host/dense_solutions.hpp"
#include "sim/second_mass.hpp"

namespace host {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

EffortRegression::EffortRegression(const sim::DriveDescription& model, const EffortRows& rows, const VectorXd& effort)
    : model_(model), rows_(rows), effort_(effort) {
  train_.resize(rows.effort.size());
  for (Index k = 0; k < train_.size(); ++k) train_(k) = rows.judges[static_cast<std::size_t>(k)] ? 0.0 : 1.0;
  effort_train_ = root_mean_square(rows, rows.effort, false);
  effort_validate_ = root_mean_square(rows, rows.effort, true);
}

void EffortRegression::weigh(const VectorXd& weights) {
  for (Index k = 0; k < train_.size(); ++k)
    if (!rows_.judges[static_cast<std::size_t>(k)]) train_(k) = weights(k);
}

bool EffortRegression::fit(const std::vector<EffortTerm>& base, const std::vector<const EffortTerm*>& further,
                           ScreenedModel& out, std::vector<std::string>* held) const {
  std::vector<const EffortTerm*> terms;
  for (const EffortTerm& term : base) terms.push_back(&term);
  terms.insert(terms.end(), further.begin(), further.end());
  std::vector<Prior> beliefs;
  std::vector<int> sign;
  Index width = 0;
  for (const EffortTerm* term : terms) width += term->columns.cols();
  MatrixXd phi(rows_.effort.size(), width);
  Index at = 0;
  const bool second_mass =
      std::ranges::any_of(further, [](const EffortTerm* term) { return sim::is_second_mass(term->kind); });
  for (std::size_t t = 0; t < terms.size(); ++t) {
    phi.middleCols(at, terms[t]->columns.cols()) = terms[t]->columns;
    at += terms[t]->columns.cols();
    for (const int s : terms[t]->sign) {
      beliefs.push_back(t < base.size() ? belief_of(t, base) : Prior{});
      // The data sheet does not say which of the two masses its inertia is.
      if (second_mass && t == 0) beliefs.back().deviation = 0.0;
      sign.push_back(s);
    }
  }
  const MatrixXd seen = train_.asDiagonal() * phi;
  const MatrixXd moments = phi.transpose() * seen;
  const VectorXd projection = seen.transpose() * effort_;
  std::vector<bool> fixed(static_cast<std::size_t>(width));
  for (std::size_t c = 0; c < fixed.size(); ++c) fixed[c] = beliefs[c].held;
  VectorXd theta = solve(moments, projection, beliefs, fixed, 0.0);
  double variance = effective_variance(phi, theta);
  for (int round = 0; round < static_cast<int>(width) + 1; ++round) {
    theta = solve(moments, projection, beliefs, fixed, variance);
    Index worst = -1;
    double most = 0.0;
    for (Index c = 0; c < width; ++c) {
      const double scale = std::sqrt(std::max(moments(c, c), 1e-300));
      if (sign[static_cast<std::size_t>(c)] > 0 && !fixed[static_cast<std::size_t>(c)] && -theta(c) * scale > most) {
        most = -theta(c) * scale;
        worst = c;
      }
    }
    if (worst < 0) break;
    // The data give a negative factor, so a small positive one is used.
    constexpr double kHardlyAny = 0.01;
    fixed[static_cast<std::size_t>(worst)] = true;
    beliefs[static_cast<std::size_t>(worst)].value *= kHardlyAny;
    if (held != nullptr && static_cast<std::size_t>(worst) < base.size())
      held->push_back(fmt::format("{} would be negative", base[static_cast<std::size_t>(worst)].kind));
  }
  if (!theta.allFinite()) return false;
  out.residual = effort_ - phi * theta;
  out.model = model_;
  out.factors = static_cast<std::size_t>(width);
  at = 0;
  for (const EffortTerm* term : terms) {
    if (!term->write(theta.segment(at, term->columns.cols()), out.model)) return false;
    at += term->columns.cols();
  }
  double acting = 1.0;
  for (const EffortTerm* term : further) acting *= term->acting;
  measure(out, acting);
  return true;
}

double EffortRegression::confidence(const ScreenedModel& before, const ScreenedModel& after) const {
  return confidence_of_improvement(squares_by_block(before.residual), squares_by_block(after.residual), 1);
}

EffortRegression::Prior EffortRegression::belief_of(std::size_t index, const std::vector<EffortTerm>& base) const {
  /// A data sheet value without a standard deviation gets half of its value as standard deviation.
  constexpr double kBelief = 0.5;
  if (base[index].deviation > 0.0) return {0.0, base[index].deviation, false};
  const std::string& kind = base[index].kind;
  const sim::EffectEntry* entry = model_.find(kind);
  const char* id = kind == "inertia" ? "J" : kind == "viscous" ? "B" : nullptr;
  double sign = 1.0;
  if (kind == "coulomb") {
    const bool backward = index > 0 && base[index - 1].kind == "coulomb";
    id = entry->has("level") ? "level" : backward ? "negative" : "positive";
    sign = backward ? -1.0 : 1.0;
  }
  if (id == nullptr) return {};
  double value = sign * entry->at(id), deviation = kBelief * std::abs(value);
  if (const auto known = entry->believed.find(id); known != entry->believed.end()) {
    value = sign * known->second.value;
    deviation = known->second.deviation;
  }
  return {value, deviation, entry->held.contains(id) || (kind == "inertia" && rows_.steady)};
}

VectorXd EffortRegression::solve(const MatrixXd& moments, const VectorXd& projection, const std::vector<Prior>& beliefs,
                                 const std::vector<bool>& fixed, double variance) const {
  MatrixXd a = moments;
  VectorXd b = projection;
  for (Index c = 0; c < b.size(); ++c) {
    const Prior& belief = beliefs[static_cast<std::size_t>(c)];
    if (fixed[static_cast<std::size_t>(c)]) continue;
    // Columns that are proportional to one another share one factor.
    constexpr double kTiny = 1e-9;
    a(c, c) *= 1.0 + kTiny;
    if (belief.deviation > 0.0) {
      a(c, c) += variance / (belief.deviation * belief.deviation);
      b(c) += variance * belief.value / (belief.deviation * belief.deviation);
    }
  }
  for (Index c = 0; c < b.size(); ++c) {
    if (!fixed[static_cast<std::size_t>(c)]) continue;
    const double value = beliefs[static_cast<std::size_t>(c)].value;
    b -= a.col(c) * value;
    a.row(c).setZero();
    a.col(c).setZero();
    a(c, c) = 1.0;
    b(c) = value;
  }
  const VectorXd scale = a.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  return scale.asDiagonal() *
         symmetric_solution(scale.asDiagonal() * a * scale.asDiagonal(), VectorXd(scale.asDiagonal() * b));
}

double EffortRegression::effective_variance(const MatrixXd& phi, const VectorXd& theta) const {
  const VectorXd residual = train_.asDiagonal() * (effort_ - phi * theta);
  double squares = 0.0, sums = 0.0, sum = 0.0;
  for (Index k = 0; k < residual.size(); ++k) {
    const auto row = static_cast<std::size_t>(k);
    if (k > 0 && rows_.block[row] != rows_.block[row - 1]) {
      sums += sum * sum;
      sum = 0.0;
    }
    sum += residual(k);
    squares += residual(k) * residual(k);
  }
  sums += sum * sum;
  return std::max(squares, sums) / std::max(train_.sum(), 1.0);
}

void EffortRegression::measure(ScreenedModel& model, double acting) const {
  model.train = root_mean_square(rows_, model.residual, false) / (acting * effort_train_);
  model.validate = root_mean_square(rows_, model.residual, true) / (acting * effort_validate_);
}

std::vector<double> EffortRegression::squares_by_block(const VectorXd& residual) const {
  std::vector<double> squares;
  std::optional<std::size_t> block;
  for (Index k = 0; k < residual.size(); ++k) {
    const auto row = static_cast<std::size_t>(k);
    if (!rows_.judges[row]) continue;
    if (block != rows_.block[row]) squares.push_back(0.0);
    block = rows_.block[row];
    squares.back() += std::pow(residual(k) / std::max(rows_.noise, 1e-12), 2);
  }
  return squares;
}

}  // namespace host
