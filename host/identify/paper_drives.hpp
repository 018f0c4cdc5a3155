// The drives of Erkorkmaz & Altintas, IJMTM 41 (2001), Table 1: what the demonstration runs on, and a data sheet for
// records of a drive called x or y.
#pragma once

#include <optional>
#include <string_view>

#include "sim/drive_description.hpp"

namespace host {

/// Axis "x" or "y" as Table 1 has it: data sheet, inertia, corrected viscous friction, Coulomb and static friction with
/// their velocity constants. Empty for any other name.
std::optional<sim::DriveDescription> paper_drive(std::string_view name);

}  // namespace host
