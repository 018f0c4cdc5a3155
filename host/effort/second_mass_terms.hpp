// A load on a spring, with or without a gap, as it shows in the effort of a motor whose motion is known.
#pragma once

#include <string>
#include <vector>

#include "host/effort/effort_terms.hpp"

namespace host {

/// Compliance and backlash: loads of many frequencies and dampings, without and with friction of their own, and, of
/// backlash, of many gaps. The column is the coupling's pull for a load of inertia 1, so that its factor is the load's
/// inertia. The terms refer to the rows. None of the kinds in `absent`. Empty where nothing accelerates, and where the
/// model has a contact already.
std::vector<EffortTerm> second_mass_terms(const sim::DriveDescription& model, const EffortRows& rows,
                                          const std::vector<std::string>& absent);

/// The narrowest gap that an encoder shows, mm or m: four of its counts. A narrower one is the spring behind it.
double least_gap(const sim::DataSheet& data);

}  // namespace host
