// Which effects may come next, with their probabilities, and which of them are certain.
#pragma once

#include <string>
#include <vector>

#include "host/effort/effort_terms.hpp"
#include "host/infer/evidence.hpp"

namespace host {

/// The kind of what the catalogue has no name for.
inline constexpr const char* kNoName = "";

/// One kind in its most probable form, given what was chosen before.
struct NextEffect {
  EffortTerm term;
  std::vector<EffortTerm> others;  ///< further forms to start a refinement from, where the kind has any
  double log_odds = 0.0;           ///< against nothing more, forms and sizes averaged out, nats
  double probability = 0.0;        ///< among all kinds and nothing more
};

/// What may come next, most probable first.
struct NextEffects {
  std::vector<NextEffect> effects;
  double nothing = 1.0;  ///< probability that no effect of the catalogue is missing
  EvidenceFit fit;       ///< without a further effect
};

/// Fewest kinds that together are certain, most probable first; empty where "nothing more" is more probable than one of
/// them, or too many are needed. `probability`: of the group.
std::vector<std::string> certain_group(const NextEffects& next, double& probability);

/// What has no name becomes "nothing of the catalogue".
void leave_unnamed(NextEffects& next);

/// Takes kinds out of what may come next; the others share their probability.
void take_out(NextEffects& next, const std::vector<std::string>& kinds);

/// The one of that kind, which must be there.
NextEffect& effect_of(NextEffects& next, const std::string& kind);

}  // namespace host
