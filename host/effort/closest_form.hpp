// Refines the shape of an effect, starting from the forms that were tried first.
#pragma once

#include <vector>

#include "host/effort/effort_regression.hpp"
#include "host/effort/effort_terms.hpp"

namespace host {

/// The form with the smallest training residual, found by repeated steps to the best neighbour of `term`, which must
/// have neighbours. `model` becomes the fitted drive.
EffortTerm closest_form(const EffortRegression& regression, const std::vector<EffortTerm>& base,
                        const std::vector<EffortTerm>& chosen, EffortTerm term, ScreenedModel& model);

}  // namespace host
