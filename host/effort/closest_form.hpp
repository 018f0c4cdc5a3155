// Refines the shape of an effect between the forms that were tried first.
#pragma once

#include <vector>

#include "host/effort/effort_regression.hpp"
#include "host/effort/effort_terms.hpp"

namespace host {

/// The form with the smallest training residual among the neighbours of `term`, which must exist, and their neighbours;
/// `model` is the resulting drive.
EffortTerm closest_form(const EffortRegression& regression, const std::vector<EffortTerm>& base,
                        const std::vector<EffortTerm>& chosen, EffortTerm term, ScreenedModel& model);

}  // namespace host
