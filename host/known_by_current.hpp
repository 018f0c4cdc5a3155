// Drives for which only the motor current was logged: the torque or force constant is known, the converter is not. The
// command in V then stands for the current in A, without a limit.
#pragma once

#include <string_view>

#include "sim/drive_description.hpp"

namespace host {

/// Changes the data sheet to that of such a drive. Needs torque_constant_Nm_per_A (linear drive: N/A).
void know_by_current(sim::DataSheet& sheet);

bool is_known_by_current(const sim::DataSheet& sheet);

/// Throws Failure(bad_input) if the data sheet is that of such a drive. `what`: the function that needs volts, for the
/// message.
void require_volts(const sim::DataSheet& sheet, std::string_view name, std::string_view what);

}  // namespace host
