#include "host/diagnose/probability.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/diagnose/claim.hpp"
#include "host/infer/posterior.hpp"

namespace host {

namespace {

/// Log of the error, with both sets weighted equally, plus the penalty for a candidate's complexity. Errors are bounded
/// below, because an error below the noise floor shows only that the noise floor is uncertain.
double cost_of(const JudgedCandidate& candidate, const ProbabilityScale& scale) {
  const auto log_error = [](double error) { return std::log(std::max(error, 0.9 * kComplete)); };
  return 0.5 * (log_error(candidate.level.validate) + log_error(candidate.level.train)) +
         scale.further * static_cast<double>(candidate.kinds.size() - 1) +
         scale.parameter * static_cast<double>(parameters_of(candidate)) +
         scale.bound * static_cast<double>(candidate.on_bound.size());
}

/// Whether the verdict names the missing effect.
bool is_claimed(const Diagnosis& diagnosis) {
  const Status status = diagnosis.verdict.status;
  return status == Status::missing || status == Status::ambiguous;
}

/// Probability that a base with these errors lacks nothing, given the verdict's objections to it.
double probability_complete(const Diagnosis& diagnosis, const ProbabilityScale& scale) {
  const double windows = static_cast<double>(
      std::max<std::size_t>(1, std::min(diagnosis.training.used_windows(), diagnosis.validation.used_windows())));
  const double error = std::max({diagnosis.before_train, diagnosis.before_validate, 0.5 * kComplete});
  const Status status = diagnosis.verdict.status;
  const double objected = status == Status::insufficient_data ? scale.unshown
                          : status == Status::unexplained     ? scale.traced
                          : is_claimed(diagnosis)             ? scale.gained
                                                              : 0.0;
  return logistic((std::log(scale.complete) - std::log(error)) / (scale.complete_by + 0.25 / std::sqrt(windows)) -
                  objected);
}

/// Probability that the error which the best candidate explains has another cause, from the share of the error that the
/// candidate leaves.
double probability_of_other(double unexplained, const Diagnosis& diagnosis, const ProbabilityScale& scale) {
  constexpr double kLeastPart = 0.01;
  const bool claimed = is_claimed(diagnosis);
  const double rough = claimed ? scale.rough_claim : scale.rough;
  const double lapse = claimed ? scale.lapse_of_claim : scale.lapse;
  const double at = claimed ? scale.other_at_claim : scale.other_at;
  const double slope = claimed ? scale.other_slope_claim : scale.other_slope;
  return lapse +
         (1.0 - lapse) * logistic(slope * std::log((unexplained + kLeastPart) / at) - (diagnosis.rough ? rough : 0.0));
}

}  // namespace

void assign_probabilities(Diagnosis& diagnosis, const ProbabilityScale& scale) {
  DiagnosisVerdict& verdict = diagnosis.verdict;
  const double nothing = probability_complete(diagnosis, scale);
  // A gain that may be chance is no evidence for a candidate or against the others. A further effect whose gain is not
  // chance shows that a candidate without it lacks something.
  std::vector<double> costs, weights;
  for (const JudgedCandidate& candidate : diagnosis.candidates) costs.push_back(cost_of(candidate, scale));
  const double least = costs.empty() ? 0.0 : *std::ranges::min_element(costs);
  double sum = 0.0;
  for (std::size_t k = 0; k < costs.size(); ++k) {
    weights.push_back((1.0 - diagnosis.candidates[k].luck) * diagnosis.candidates[k].suffices *
                      std::exp((least - costs[k]) / scale.tie));
    sum += weights.back();
  }
  if (!(sum > 0.0)) {
    verdict.probability_nothing = nothing;
    verdict.probability_other = 1.0 - nothing;
    return;
  }
  const JudgedCandidate* best =
      &diagnosis.candidates[static_cast<std::size_t>(std::ranges::max_element(weights) - weights.begin())];
  const double explained = std::min(explained_share(diagnosis.base_level.train, best->level.train),
                                    explained_share(diagnosis.base_level.validate, best->level.validate));
  const double other = probability_of_other(1.0 - explained, diagnosis, scale);
  double candidates = 0.0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    diagnosis.candidates[k].probability = (1.0 - nothing) * (1.0 - other) * (1.0 - best->luck) * weights[k] / sum;
    candidates += diagnosis.candidates[k].probability;
  }
  verdict.probability_nothing = nothing;
  verdict.probability_other = 1.0 - nothing - candidates;
}

}  // namespace host
