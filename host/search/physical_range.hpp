// Parameters with which a fitted effect is not that effect any more.
#pragma once

#include <string>
#include <vector>

#include "host/compare/comparison.hpp"

namespace host {

/// Parameters of the effects in `kinds` that are at a bound of their range, for example "compliance: damping_ratio". A
/// bound at which that part of the effect is absent is allowed (sim::ParameterInfo::is_stopped_at).
std::vector<std::string> parameters_on_bound(const sim::DriveDescription& model, const std::vector<std::string>& kinds);

/// The same, and positions so far outside the travel of the records that the effect hardly changes over the travel and
/// stands in for a constant.
std::vector<std::string> unphysical_parameters(const sim::DriveDescription& model,
                                               const std::vector<std::string>& kinds, const RecordSet& training);

}  // namespace host
