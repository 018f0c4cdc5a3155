// An identification as JSON for other programs: `axis-identification/1`.
#pragma once

#include <nlohmann/json.hpp>

#include "host/identify/identification.hpp"

namespace host {

nlohmann::json identification_json(const Identification& identification);

/// {"value": …, "ci95": [lo, hi]}
nlohmann::json estimate_json(const Estimate& estimate);

}  // namespace host
