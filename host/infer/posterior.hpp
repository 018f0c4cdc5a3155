// Converts log evidence to probabilities, and these to claims.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace host {

/// Least probability of named effects together: a wrong name sends a mechanic to the wrong part, which costs some
/// twenty times as much as another record.
inline constexpr double kClaimed = 0.95;
/// Least part of the remaining squared error on held-back records that the first named effect must explain: with less,
/// the error itself (its root) falls by less than 5 %, which is not noticeable on the machine.
inline constexpr double kWorthNaming = 0.1;
/// The same for the squared error of the base: after the first effect, a tenth of the error is not noticeable.
inline constexpr double kWorthOfAll = 0.01;
/// Unless it explains the larger part of the remaining error.
inline constexpr double kWorthOfLeft = 0.5;
/// Whether an effect that takes an error (RMS, any unit) from `before` to `after` is to be named, where the base alone
/// leaves `base`: what is certain need not be important.
inline bool is_worth_naming(double before, double after, double base) {
  const double left = before * before, taken = left - after * after;
  return taken >= kWorthOfLeft * left || (taken >= kWorthNaming * left && taken >= kWorthOfAll * base * base);
}

/// Prior: that nothing (more) is missing is as probable as that something is.
inline constexpr double kNothingMore = 0.5;

/// Probability for these log odds, nats.
inline double logistic(double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); }

/// ln(sum(exp(values))).
inline double log_sum(const std::vector<double>& values) {
  const double most = *std::ranges::max_element(values);
  double sum = 0.0;
  for (const double value : values) sum += std::exp(value - most);
  return most + std::log(sum);
}

/// Probabilities of hypotheses with these log evidences plus log priors; they sum to 1.
inline std::vector<double> posterior(const std::vector<double>& logs) {
  const double all = log_sum(logs);
  std::vector<double> probabilities;
  for (const double value : logs) probabilities.push_back(std::exp(value - all));
  return probabilities;
}

}  // namespace host
