// A drive's data sheet in a set of board parameters: what a count, a step of the converter and the travel of a turn
// are.
#pragma once

#include "firmware/app/parameters/parameter_values.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// The set with the scales of one axis as the data sheet has them; the rest stays. Throws Failure(bad_input) for a data
/// sheet that lacks the resolution of encoder or converter.
firmware::ParameterValues with_data_sheet(firmware::ParameterValues values, std::size_t axis,
                                          const sim::DataSheet& data);

/// The scale of this axis's counts has not been set.
bool has_initial_scales(const firmware::ParameterValues& values, std::size_t axis);

}  // namespace host
