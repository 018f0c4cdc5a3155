// A plan and a decision as JSON documents (`axis-plan/1`, `axis-decision/1`).
#pragma once

#include <nlohmann/json.hpp>

#include "host/plan/experiment_plan.hpp"

namespace host {

/// `run_file`: file of the run. The document names it if there is a run.
nlohmann::json to_json(const Plan& plan, const std::string& run_file);

nlohmann::json to_json(const Decision& decision);

}  // namespace host
