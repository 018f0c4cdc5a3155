// Converts log evidence to probabilities, and decides which effects to name.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace host {

/// Least probability that all named effects are present. A wrong name sends a mechanic to the wrong part, which costs
/// some twenty times as much as another record.
inline constexpr double kClaimed = 0.95;
/// Probability below which an effect is not looked at as a rival: even if it were 500 times more probable, it would not
/// reach the 5 % that a claim leaves to others.
inline constexpr double kPossible = 1e-4;
/// Largest group of rivals: one further measurement can separate this many.
inline constexpr std::size_t kLargestGroup = 4;
/// Least part of the remaining squared error on held-back records that the first named effect must explain. With less,
/// the RMS error would fall by less than 5 %, which is not noticeable on the machine.
inline constexpr double kWorthNaming = 0.1;
/// Least part of the squared error of the base that an effect must also explain.
inline constexpr double kWorthOfAll = 0.01;
/// An effect that explains at least this part of the remaining squared error is also worth naming.
inline constexpr double kWorthOfLeft = 0.5;
/// Whether an effect that reduces an error (RMS, any unit) from `before` to `after` is large enough to be named.
/// `base`: error of the base alone. An effect can be certain but unimportant.
inline bool is_worth_naming(double before, double after, double base) {
  const double left = before * before, taken = left - after * after;
  return taken >= kWorthOfLeft * left || (taken >= kWorthNaming * left && taken >= kWorthOfAll * base * base);
}

/// Prior probability that nothing (more) is missing.
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
