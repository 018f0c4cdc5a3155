// Adds one named effect: `axis-addition/1`.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "host/diagnose/improvement.hpp"

namespace host {

/// add_effect, or add_free_curve where `kind` is "free_curve": only it takes `over`. Throws Failure(usage) if another
/// kind gives it, Failure(refused) if no part of the records can validate the fit, and what those two throw.
Addition add_kind(const sim::DriveDescription& model, const std::string& kind, const std::string& over,
                  const Measurements& measured);

/// `model_path`: path of the new model; may be empty.
nlohmann::json to_json(const Addition& addition, const std::string& kind, const Measurements& measured,
                       const std::string& model_path);

}  // namespace host
