// Refines the shape of an effect, starting from the forms that were tried first.
#pragma once

#include <vector>

#include "host/effort/effort_regression.hpp"
#include "host/effort/effort_terms.hpp"

namespace host {

/// A form of an effect and the drive that is fitted with it.
struct FittedForm {
  EffortTerm term;
  ScreenedModel model;
};

/// The form with the smallest training residual, found by repeated steps to a better neighbour, from each of the starts
/// at the same time. All starts have neighbours and are of one kind; there is at least one.
FittedForm closest_form(const EffortRegression& regression, const std::vector<EffortTerm>& base,
                        const std::vector<EffortTerm>& chosen, std::vector<FittedForm> starts);

}  // namespace host
