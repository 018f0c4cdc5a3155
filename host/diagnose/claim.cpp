#include "host/diagnose/claim.hpp"

#include <algorithm>
#include <cmath>

#include "host/compare/chance.hpp"
#include "host/diagnose/probability.hpp"

namespace host {

namespace {

/// Significance level of the block bootstrap over validation windows. 5 % suffices because the limits of gain and share
/// below exclude chance (no chance candidate came near them). 1 % on a machine limited by model error, where the limit
/// of share is low.
constexpr double kLeastConfidence = 0.95;
constexpr double kLeastRoughConfidence = 0.99;
/// Least share of the explainable error that an effect must explain to be claimed.
constexpr double kLeastShare = 0.35;
/// The same on a machine limited by model error, whose residual has many small causes.
constexpr double kLeastRoughShare = 0.1;
/// A true effect leaves 2 % of the error (late impacts and breakaways); two true effects of three leave about 15 %.
/// Effects that stand in for unknown ones left 40 % and more, two effects that stand in for an unknown friction curve
/// 20 %. Not applied to a machine limited by model error.
constexpr double kMostLeft = 0.15;
/// Errors over noise floor above this need an explanation.
constexpr double kSomething = 1.1;

bool gains(const JudgedCandidate& candidate, const Diagnosis& diagnosis) {
  // If the base is probably complete, an improvement of it is not an explanation.
  if (std::max(candidate.before, diagnosis.before_train) < ProbabilityScale{}.complete) return false;
  const double least = diagnosis.rough ? kLeastRoughShare : kLeastShare;
  const auto on = [&](double before, double after) {
    return before > kSomething && after < (1.0 - kLeastGain) * before && explained_share(before, after) >= least;
  };
  return on(candidate.before, candidate.after) && on(diagnosis.before_train, candidate.train_after);
}

double combined_of_both(const JudgedCandidate& candidate) { return std::sqrt(candidate.train_after * candidate.after); }

}  // namespace

double explained_by(const JudgedCandidate& candidate, const Diagnosis& diagnosis) {
  return std::min(explained_share(candidate.before, candidate.after),
                  explained_share(diagnosis.before_train, candidate.train_after));
}

double level_of_both(const SetLevels& level) { return std::sqrt(level.train * level.validate); }

bool is_better(const JudgedCandidate& one, const JudgedCandidate& other, double share) {
  const double level = level_of_both(one.level), least = level_of_both(other.level);
  return level < least &&
         (level < (1.0 - share) * least || combined_of_both(one) < (1.0 - share) * combined_of_both(other));
}

double explained_beyond(const JudgedCandidate& less, const JudgedCandidate& more) {
  const auto above_noise = [](const JudgedCandidate& candidate) {
    return std::sqrt(std::max(candidate.train_after, kComplete) * std::max(candidate.after, kComplete));
  };
  return explained_share(above_noise(less), above_noise(more));
}

std::size_t parameters_of(const JudgedCandidate& candidate) {
  std::size_t count = 0;
  for (const std::string& kind : candidate.kinds)
    if (const sim::EffectEntry* entry = candidate.model.find(kind)) count += entry->parameters.size();
  return count;
}

Reservation reservation_about(const JudgedCandidate& candidate, const Diagnosis& diagnosis) {
  if (!gains(candidate, diagnosis)) return Reservation::no_gain;
  if (!candidate.on_bound.empty()) return Reservation::on_bound;
  if (!diagnosis.rough && explained_by(candidate, diagnosis) < 1.0 - kMostLeft) return Reservation::leaves_much;
  if (candidate.luck > kMostLuck || candidate.confidence < (diagnosis.rough ? kLeastRoughConfidence : kLeastConfidence))
    return Reservation::luck;
  return Reservation::none;
}

double least_validation_s(std::size_t tried) {
  // The probability that all of m blocks improve by chance is 2^-m.
  return kLuckBlock_s * std::ceil(std::log2(static_cast<double>(std::max<std::size_t>(1, tried)) / kMostLuck));
}

}  // namespace host
