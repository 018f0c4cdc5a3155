// Torque or force that a load on a spring, with or without a gap, exerts on a motor with known motion.
#pragma once

#include <string>
#include <vector>

#include "host/effort/effort_terms.hpp"

namespace host {

/// Terms of compliance and backlash: loads with many frequencies and dampings, with and without friction of their own,
/// and for backlash with many gaps. The column is the force of the coupling for a load of inertia 1, so its factor is
/// the inertia of the load. The terms refer to the rows. Kinds in `absent` are left out. Empty if the axis does not
/// accelerate or the model already has a contact.
std::vector<EffortTerm> second_mass_terms(const sim::DriveDescription& model, const EffortRows& rows,
                                          const std::vector<std::string>& absent);

/// The narrowest gap that an encoder resolves, mm or m: four counts. A narrower gap is replaced by a spring.
double least_gap(const sim::DataSheet& data);

}  // namespace host
