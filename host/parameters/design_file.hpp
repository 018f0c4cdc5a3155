// A design as a file of one axis's parameters (`axis-params/1`), with compensations and filters.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "host/identify/axis_design.hpp"
#include "host/parameters/board_parameters.hpp"
#include "host/parameters/control_filters.hpp"

namespace host {

/// Board parameters, compensations of the model's effects and filters. Throws as core_filters() if a filter is out of
/// its range.
std::string design_toml(const sim::DriveDescription& model, const AxisDesign& design,
                        const ControlFilterChoice& filters, const ReferenceLimits& limits);

/// {"notch": {…}, "low_pass": {…}}; null for a filter that is off.
nlohmann::json filter_json(const ControlFilterChoice& filters);

}  // namespace host
