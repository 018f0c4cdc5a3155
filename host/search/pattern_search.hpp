// Search without gradients, for errors whose gradient is misleading because of impacts.
#pragma once

#include "host/compare/comparison.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Changes the parameters of the model's last effect one at a time, by decreasing factors, while SetError::robust falls
/// (R. Hooke, T. A. Jeeves, Journal of the ACM 8, 1961). Stays within the catalogue's bounds. Needs some eighty
/// evaluations, at most a few hundred, and ends after `most_steps` integrator steps.
sim::DriveDescription pattern_search(const sim::DriveDescription& model, const RecordSet& set, double most_steps);

}  // namespace host
