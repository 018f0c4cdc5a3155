// A design as JSON for other programs: `axis-design/1`.
#pragma once

#include <nlohmann/json.hpp>

#include "host/identify/axis_design.hpp"

namespace host {

nlohmann::json design_json(const AxisDesign& design);

}  // namespace host
