// Starting values of effects from a frequency response.
#pragma once

#include <string>
#include <vector>

#include "host/response/plant_fit.hpp"
#include "sim/drive_description.hpp"

namespace host {

struct ModelStarts {
  sim::DriveDescription model;
  std::vector<std::string> said;  ///< messages: effects that were added, and those left out with the reason
};

/// The model with `compliance` from the lowest resonance and `input_delay` from the delay, with their intervals, if
/// they are significant and within the catalogue's bounds; held values are kept. A current-loop lag of the same time
/// has nearly the same phase, and `said` mentions it. `from`: the records' name.
ModelStarts with_response(const sim::DriveDescription& model, const PlantFit& fit, const std::string& from);

}  // namespace host
