// One effect at a word: `axis-addition/1`.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "host/diagnose/improvement.hpp"

namespace host {

/// add_effect, or add_free_curve where `kind` is "free_curve": `over` belongs to it alone. Throws Failure(usage) where
/// it does not, Failure(refused) where no stretch of the records judges what was fitted, and what those two throw.
Addition add_kind(const sim::DriveDescription& model, const std::string& kind, const std::string& over,
                  const Measurements& measured);

/// `model_path` is where the new model went; may be empty.
nlohmann::json to_json(const Addition& addition, const std::string& kind, const Measurements& measured,
                       const std::string& model_path);

}  // namespace host
