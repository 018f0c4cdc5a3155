// Two effects that mask each other: with either of them alone, the residual varies as before.
#pragma once

#include <functional>
#include <vector>

#include "host/effort/effort_regression.hpp"
#include "host/effort/next_effects.hpp"

namespace host {

/// Finds the pair with the smallest training residual that together explains more of the squared error than the sum of
/// both alone, in training and in validation. Returns the one that explains less alone; null if no such pair is large
/// enough to be named. Waves are excluded: together they fit any shape. `now`: the effects chosen so far, fitted.
const NextEffect* less_seen_of_two(const EffortRegression& regression, const std::vector<EffortTerm>& base,
                                   const std::vector<EffortTerm>& chosen, const ScreenedModel& now,
                                   const NextEffects& all,
                                   const std::function<bool(const ScreenedModel&)>& is_worth_naming);

}  // namespace host
