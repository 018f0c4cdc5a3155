// Drives of which a log of the motor current is all there is: torque or force is known by the current alone, and no
// converter. A volt stands for an ampere then, and nothing limits it.
#pragma once

#include <string_view>

#include "sim/drive_description.hpp"

namespace host {

/// Makes it such a one; its torque_constant_Nm_per_A (N/A) is given.
void know_by_current(sim::DataSheet& sheet);

bool is_known_by_current(const sim::DataSheet& sheet);

/// Throws Failure(bad_input) where the data sheet is such a one. `what`: what commands volts, for the message.
void require_volts(const sim::DataSheet& sheet, std::string_view name, std::string_view what);

}  // namespace host
