// Finds two effects that mask each other: either of them alone hardly reduces the residual.
#pragma once

#include <functional>
#include <vector>

#include "host/effort/effort_regression.hpp"
#include "host/effort/next_effects.hpp"

namespace host {

/// Finds the pair with the smallest training residual that explains more of the squared error than both effects alone
/// together, in training and in validation. Returns the effect that explains less alone; null if no such pair is large
/// enough to be named. Waves are excluded, because several waves fit any shape. `now`: fitted model with the effects
/// chosen so far.
const NextEffect* less_seen_of_two(const EffortRegression& regression, const std::vector<EffortTerm>& base,
                                   const std::vector<EffortTerm>& chosen, const ScreenedModel& now,
                                   const NextEffects& all,
                                   const std::function<bool(const ScreenedModel&)>& is_worth_naming);

}  // namespace host
