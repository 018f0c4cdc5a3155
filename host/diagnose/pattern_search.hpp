// Search without slopes, where impacts make the error so jagged that its slope misleads.
#pragma once

#include "host/compare/comparison.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Moves the parameters of the model's last effect, one at a time and by factors that shrink, as long as
/// SetError::robust falls (R. Hooke, T. A. Jeeves, Journal of the ACM 8, 1961). Stays within the catalogue's bounds;
/// takes some eighty evaluations, a few hundred at most, and ends after `most_steps` of the integrator.
sim::DriveDescription pattern_search(const sim::DriveDescription& model, const RecordSet& set, double most_steps);

}  // namespace host
