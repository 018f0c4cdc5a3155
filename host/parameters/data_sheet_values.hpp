// Writes a drive's data sheet into a set of board parameters: scales of a count, a converter step and a turn.
#pragma once

#include "firmware/app/parameters/parameter_values.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// The set with the data sheet's scales for one axis; all else is unchanged. Throws Failure(bad_input) for a data sheet
/// that lacks the resolution of encoder or converter.
firmware::ParameterValues with_data_sheet(firmware::ParameterValues values, std::size_t axis,
                                          const sim::DataSheet& data);

/// Whether the scale of this axis's counts has not been set.
bool has_initial_scales(const firmware::ParameterValues& values, std::size_t axis);

}  // namespace host
