// Candidates for the next effect with their probabilities, and those that are certain.
#pragma once

#include <string>
#include <vector>

#include "host/effort/effort_terms.hpp"
#include "host/infer/evidence.hpp"

namespace host {

/// Kind for effects that the catalogue does not contain.
inline constexpr const char* kNoName = "";

/// One kind in its most probable form, given the effects chosen before.
struct NextEffect {
  EffortTerm term;
  std::vector<EffortTerm> others;  ///< further forms to start a refinement from, if any
  double log_odds = 0.0;           ///< log odds against no further effect, integrated over forms and sizes, nats
  double probability = 0.0;        ///< among all kinds and no further effect
};

/// Candidates for the next effect, most probable first.
struct NextEffects {
  std::vector<NextEffect> effects;
  double nothing = 1.0;  ///< probability that no effect of the catalogue is missing
  EvidenceFit fit;       ///< without a further effect
};

/// Fewest kinds that are certain together, most probable first; empty if no further effect is more probable than one of
/// them, or too many are needed. `probability`: of the group.
std::vector<std::string> certain_group(const NextEffects& next, double& probability);

/// Counts the effect outside the catalogue as "nothing of the catalogue".
void leave_unnamed(NextEffects& next);

/// Removes kinds from the candidates; the others share their probability.
void take_out(NextEffects& next, const std::vector<std::string>& kinds);

/// Removes all kinds from the candidates.
void leave_nothing(NextEffects& next);

/// Replaces the candidates of `kind` and of its own kind by a candidate with the probability of both.
void give_place(NextEffects& next, const std::string& kind, NextEffect to);

/// The candidate of that kind, which must exist.
NextEffect& effect_of(NextEffects& next, const std::string& kind);

}  // namespace host
