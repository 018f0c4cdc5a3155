// Adds named effects: `axis-addition/1`.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/diagnose/improvement.hpp"

namespace host {

/// The effects of "cogging" or "backlash+cogging", known or not. Throws Failure(usage) for a free curve with others.
std::vector<std::string> added_kinds(const std::string& kind);

/// Calls add_free_curve() if `kind` is "free_curve", otherwise add_effects() with added_kinds(). Only a free curve
/// accepts `over`: Failure(usage) if another kind gives it. Throws Failure(refused) if no part of the records can
/// validate the fit, and what the called function throws.
Addition add_kind(const sim::DriveDescription& model, const std::string& kind, const std::string& over,
                  const Measurements& measured);

/// `model_path`: path of the new model; may be empty.
nlohmann::json to_json(const Addition& addition, const std::string& kind, const Measurements& measured,
                       const std::string& model_path);

}  // namespace host
