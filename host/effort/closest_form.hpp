// The best shape of an effect between those that are tried first.
#pragma once

#include <vector>

#include "host/effort/effort_regression.hpp"
#include "host/effort/effort_terms.hpp"

namespace host {

/// The form that leaves least of the training rows' torque or force among the neighbours of `term`, which must have
/// some, and theirs; `model` is what it makes of the drive.
EffortTerm closest_form(const EffortRegression& regression, const std::vector<EffortTerm>& base,
                        const std::vector<EffortTerm>& chosen, EffortTerm term, ScreenedModel& model);

}  // namespace host
