// A comparison for people: on the terminal, and as an HTML page.
#pragma once

#include <span>
#include <string>

#include "host/compare/comparison_figures.hpp"
#include "host/report/report.hpp"
#include "host/report/terminal.hpp"

namespace host {

/// Verdict, log faults, errors by record and channel, and the regions that stand out. At least one model.
std::string comparison_text(std::span<const ComparedModel> models, const Terminal& terminal);

/// Verdict, facts, traces of the record with the largest error, error by regime and the other partitions, and the
/// missing effort against speed, position, time and acceleration; of several models on top of each other.
Report comparison_report(std::span<const ComparedModel> models);

}  // namespace host
