// Report of a plan before the axis moves: the run, its expected result, and how the predictions of the rivals differ.
#pragma once

#include <string>

#include "host/plan/experiment_plan.hpp"

namespace host {

/// Writes a self-contained HTML report. `run_file`: file name in the command that makes the run.
void write_plan_report(const Plan& plan, const std::string& model_name, const std::string& run_file,
                       const std::string& path);

}  // namespace host
