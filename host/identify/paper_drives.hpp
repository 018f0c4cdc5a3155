// The drives of Erkorkmaz & Altintas, IJMTM 41 (2001), Table 1. The demonstration uses them, and they are the data
// sheets for records of a drive called x or y.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Axis "x" or "y" of Table 1: data sheet, inertia, corrected viscous friction, Coulomb and static friction with their
/// velocity constants. Empty for any other name.
std::optional<sim::DriveDescription> paper_drive(std::string_view name);

/// The paper's drive that a record names, if there is no data sheet; adds a note to `warnings`. Throws Failure(usage)
/// if the record names none of them.
sim::DriveDescription drive_named_by(const Record& record, std::vector<std::string>& warnings);

}  // namespace host
