// The candidates for the next effect with their probabilities, and the group that is certain.
#pragma once

#include <string>
#include <vector>

#include "host/effort/effort_terms.hpp"
#include "host/infer/evidence.hpp"

namespace host {

/// Kind of effects that the catalogue does not contain.
inline constexpr const char* kNoName = "";

/// One kind in its most probable form, given the effects chosen before.
struct NextEffect {
  EffortTerm term;
  std::vector<EffortTerm> others;  ///< further forms from which a refinement starts; may be empty
  double log_odds = 0.0;           ///< log odds over no further effect, nats, integrated over forms and sizes
  double log_weight = 0.0;         ///< the same plus the log of the prior of its kind
  double probability = 0.0;        ///< probability compared with all kinds and no further effect
};

/// Candidates for the next effect, most probable first.
struct NextEffects {
  std::vector<NextEffect> effects;
  double nothing = 1.0;      ///< probability that no effect of the catalogue is missing
  double log_nothing = 0.0;  ///< log of its prior
  EvidenceFit fit;           ///< the fit without a further effect
};

/// Sets the probabilities from the logs, in which odds of thousands of nats do not vanish.
void renew_probabilities(NextEffects& next);

/// The smallest set of kinds of which one is certain, most probable first. Empty if no further effect is more probable
/// than one of them, or if the set is too large. `probability`: receives that of the group.
std::vector<std::string> certain_group(const NextEffects& next, double& probability);

/// Adds the probability of the effect outside the catalogue to that of no effect of the catalogue.
void leave_unnamed(NextEffects& next);

/// Removes kinds from the candidates and divides their probability among the others.
void take_out(NextEffects& next, const std::vector<std::string>& kinds);

/// Removes all kinds from the candidates.
void leave_nothing(NextEffects& next);

/// Replaces the candidate `kind`, and an earlier candidate of the kind of `to`, by `to` with the probability of both.
void give_place(NextEffects& next, const std::string& kind, NextEffect to);

/// The candidate of that kind, which must exist.
NextEffect& effect_of(NextEffects& next, const std::string& kind);

}  // namespace host
