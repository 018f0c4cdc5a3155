// What a plan shows before anything moves: the run, what is expected of it, and how the rivals part.
#pragma once

#include <string>

#include "host/plan/experiment_plan.hpp"

namespace host {

/// Writes a self-contained HTML report. `run_file` stands in the command that makes the run.
void write_plan_report(const Plan& plan, const std::string& model_name, const std::string& run_file,
                       const std::string& path);

}  // namespace host
