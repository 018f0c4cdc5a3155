// Report of a plan before anything moves: the run, its expected result, and how the rivals' predictions differ.
#pragma once

#include <string>

#include "host/plan/experiment_plan.hpp"

namespace host {

/// Writes a self-contained HTML report. `run_file` is the file in the command that makes the run.
void write_plan_report(const Plan& plan, const std::string& model_name, const std::string& run_file,
                       const std::string& path);

}  // namespace host
