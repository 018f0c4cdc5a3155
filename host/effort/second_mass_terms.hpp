// Torque or force on a motor with known motion from a load on a spring, with or without a gap.
#pragma once

#include <string>
#include <vector>

#include "host/effort/effort_terms.hpp"

namespace host {

/// Terms of compliance and backlash: loads with many frequencies and dampings, with and without friction of their own,
/// and for backlash with many gaps. The column is the coupling's pull for a load of inertia 1, so its factor is the
/// load's inertia. The terms refer to the rows. Kinds in `absent` are left out. Empty if nothing accelerates, or if the
/// model already has a contact.
std::vector<EffortTerm> second_mass_terms(const sim::DriveDescription& model, const EffortRows& rows,
                                          const std::vector<std::string>& absent);

/// The narrowest gap that an encoder resolves, mm or m: four counts. A narrower one is replaced by the spring behind
/// it.
double least_gap(const sim::DataSheet& data);

}  // namespace host
