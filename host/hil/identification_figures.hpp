// The paper's Figs 6 to 8 for a drive that a scenario commissions.
#pragma once

#include <cstdint>
#include <string_view>

#include "host/report/report.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Repeats the open-loop steps of the commissioning (with its `seed`) at the paper's scalings, and adds: the steps and
/// their speeds, the estimates over the scaling, and the predicted speeds with their errors.
void add_identification_figures(const sim::DriveDescription& machine, std::string_view axis, std::uint64_t seed,
                                Report& report);

}  // namespace host
