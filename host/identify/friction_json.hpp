// A friction curve as JSON for other programs: `axis-friction/1`.
#pragma once

#include <nlohmann/json.hpp>

#include "host/identify/friction_identification.hpp"

namespace host {

/// Parameters with intervals, the points, and the curve at 61 speeds in each direction, with equal ratios.
nlohmann::json friction_json(const FrictionIdentification& identification);

}  // namespace host
