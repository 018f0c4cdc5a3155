// Two effects that hide each other: beside either of them alone, what is left wanders as it did before.
#pragma once

#include <functional>
#include <vector>

#include "host/effort/effort_regression.hpp"
#include "host/effort/next_effects.hpp"

namespace host {

/// Of the two that leave least of the training rows, and take more of the squared error together than what each takes
/// alone adds up to, on training and on validation rows: the one that takes less alone. Null where no two do so and are
/// worth naming. Waves take part in no pair: together they take any shape. `now`: what was chosen so far, fitted.
const NextEffect* less_seen_of_two(const EffortRegression& regression, const std::vector<EffortTerm>& base,
                                   const std::vector<EffortTerm>& chosen, const ScreenedModel& now,
                                   const NextEffects& all,
                                   const std::function<bool(const ScreenedModel&)>& is_worth_naming);

}  // namespace host
