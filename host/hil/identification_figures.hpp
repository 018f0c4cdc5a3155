// The paper's Figs 6 to 8 for a drive that a scenario commissions.
#pragma once

#include <cstdint>
#include <string_view>

#include "host/report/report.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Runs the open-loop steps of the commissioning (its `seed`) again, scaled as the paper scaled them, and adds: the
/// steps and the speeds they give, the estimates over the scaling, and the predicted speeds with their errors.
void add_identification_figures(const sim::DriveDescription& machine, std::string_view axis, std::uint64_t seed,
                                Report& report);

}  // namespace host
