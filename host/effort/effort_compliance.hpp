// A load on a spring, as it shows in the effort of a motor whose motion is known.
#pragma once

#include <vector>

#include "host/effort/effort_terms.hpp"

namespace host {

/// Appends loads of many frequencies and dampings, without and with Coulomb friction of their own. The column is the
/// spring's pull for a load of inertia 1, so that its factor is the load's inertia.
void append_compliance(const sim::DriveDescription& model, const EffortRows& rows, std::vector<EffortTerm>& terms);

}  // namespace host
