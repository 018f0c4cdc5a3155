// Converts log evidence to probabilities, and these to claims.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace host {

/// What is named must hold this probability together: a wrong name sends a mechanic to the wrong part, which costs some
/// twenty times what another record does.
inline constexpr double kClaimed = 0.95;
/// Of the squared error that is left on held-back records, what an effect must take to be named first: with less the
/// error itself (its root) falls by less than 5 %, which nobody sees in the machine's work.
inline constexpr double kWorthNaming = 0.1;
/// And of the squared error that the base leaves there: beside what was found first, a tenth of the error is not seen.
inline constexpr double kWorthOfAll = 0.01;
/// Unless it takes the larger part of what is left.
inline constexpr double kWorthOfLeft = 0.5;
/// Before the measurement, that nothing (more) is missing is as probable as that something is.
inline constexpr double kNothingMore = 0.5;

/// Probability of what has these log odds, nats.
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
