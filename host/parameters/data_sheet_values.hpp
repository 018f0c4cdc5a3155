// Writes a drive's data sheet into a set of board parameters: the scales of counts, converter steps and turns.
#pragma once

#include "firmware/app/parameters/parameter_values.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// The set with the data sheet's scales for one axis; all other values are unchanged. Throws Failure(bad_input) if the
/// data sheet lacks the resolution of encoder or converter.
firmware::ParameterValues with_data_sheet(firmware::ParameterValues values, std::size_t axis,
                                          const sim::DataSheet& data);

/// Whether the scale of this axis's counts still has its initial value.
bool has_initial_scales(const firmware::ParameterValues& values, std::size_t axis);

}  // namespace host
