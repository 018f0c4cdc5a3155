// A comparison for people: on the terminal, and as an HTML page.
#pragma once

#include <string>

#include "host/compare/model_comparison.hpp"
#include "host/report/report.hpp"
#include "host/report/terminal.hpp"

namespace host {

/// The answer in plain words.
Verdict comparison_verdict(const ModelComparison& comparison);

/// Verdict, log faults, errors by record and channel, and the regions that stand out.
std::string comparison_text(const sim::DriveDescription& model, const ModelComparison& comparison,
                            const Terminal& terminal);

/// Verdict, facts, traces of the record with the largest error, error by regime and the other partitions, and the
/// missing effort against speed, position, time and acceleration.
Report comparison_report(const sim::DriveDescription& model, const RecordSet& set, const ModelComparison& comparison);

}  // namespace host
