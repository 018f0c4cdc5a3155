// All steps on one page, from the given model to the present one.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/workbench/folder.hpp"
#include "host/workbench/request.hpp"

namespace host::workbench {

/// The models of `request` (the given one first) against its records, the errors step by step, what was fitted, and the
/// commands that repeat it. `steps`: states of the jobs that led to the model (Jobs::steps_to()). Throws as compare()
/// does, and Failure(bad_input) where a job's document is damaged.
std::string story_page(const Folder& folder, const Request& request, const std::vector<nlohmann::json>& steps);

}  // namespace host::workbench
