// What a frequency response says of a model: starts for effects that it shows.
#pragma once

#include <string>
#include <vector>

#include "host/response/plant_fit.hpp"
#include "sim/drive_description.hpp"

namespace host {

struct ModelStarts {
  sim::DriveDescription model;
  std::vector<std::string> said;  ///< what was put in, and what was left out and why
};

/// The model with `compliance` from the lowest resonance and `input_delay` from the delay, with their intervals, where
/// they lie within the catalogue's bounds and stand out of their uncertainty; values that are held stay. A lag of the
/// current loop of the same time looks alike in phase: `said` mentions it. `from`: the records' name.
ModelStarts with_response(const sim::DriveDescription& model, const PlantFit& fit, const std::string& from);

}  // namespace host
