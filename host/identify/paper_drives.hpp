// The drives of Erkorkmaz & Altintas, IJMTM 41 (2001), Table 1: used by the demonstration, and as data sheet for
// records of a drive called x or y.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Axis "x" or "y" as Table 1 has it: data sheet, inertia, corrected viscous friction, Coulomb and static friction with
/// their velocity constants. Empty for any other name.
std::optional<sim::DriveDescription> paper_drive(std::string_view name);

/// The paper's drive that a record names, if no data sheet was given; says so in `warnings`. Throws Failure(usage) if
/// it names none.
sim::DriveDescription drive_named_by(const Record& record, std::vector<std::string>& warnings);

}  // namespace host
