// A page with all steps from the given model to the present one.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/workbench/folder.hpp"
#include "host/workbench/request.hpp"

namespace host::workbench {

/// Contains the comparison of the models of `request` (the given one first) with its records, the errors of each step,
/// the fitted parameters, and the commands that repeat the steps. `steps`: states of the jobs that led to the model
/// (Jobs::steps_to()). Throws as compare() does, and Failure(bad_input) if a job's document is damaged.
std::string story_page(const Folder& folder, const Request& request, const std::vector<nlohmann::json>& steps);

}  // namespace host::workbench
