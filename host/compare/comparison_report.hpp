// A comparison as text for a terminal and as an HTML page.
#pragma once

#include <span>
#include <string>

#include "host/compare/comparison_figures.hpp"
#include "host/report/report.hpp"
#include "host/report/terminal.hpp"

namespace host {

/// Verdict, log faults, errors by record and channel, and the regions with the largest error. Needs at least one model.
std::string comparison_text(std::span<const ComparedModel> models, const Terminal& terminal);

/// Verdict, facts, traces of one record, the missing torque or force over speed, position, acceleration, time and
/// history, the error by motion, and the other partitions. Several models share each plot. Throws as record_in() does.
Report comparison_report(std::span<const ComparedModel> models, const Focus& focus = {});

}  // namespace host
