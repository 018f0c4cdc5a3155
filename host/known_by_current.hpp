// Drives for which only the motor current was logged: torque or force is known only for the current, and the converter
// is unknown. Then a volt stands for an ampere, without a limit.
#pragma once

#include <string_view>

#include "sim/drive_description.hpp"

namespace host {

/// Changes the data sheet to such a drive; its torque_constant_Nm_per_A (N/A) must be given.
void know_by_current(sim::DataSheet& sheet);

bool is_known_by_current(const sim::DataSheet& sheet);

/// Throws Failure(bad_input) if the data sheet is of such a drive. `what`: the part that commands volts, for the
/// message.
void require_volts(const sim::DataSheet& sheet, std::string_view name, std::string_view what);

}  // namespace host
