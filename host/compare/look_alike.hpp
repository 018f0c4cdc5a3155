// Which effects look like the residual over a coordinate: by the shape of each effect's own part on the same records.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "host/compare/comparison_figures.hpp"

namespace host {

struct LookAlike {
  std::string kind;
  /// Correlation of the two curves, forward and backward together, over their common bins; 0 to 1. A shape, not a
  /// probability: effects of one shape differ only in other motions.
  double likeness = 0.0;
};

/// The effects that the model lacks, the most alike first. Each is added with the values of its example; its own part
/// is the torque or force that it takes off the residual. A ripple gets the period, a whole fraction of `period` (mm,
/// m), that fits the residual best, and any phase. `coordinate`: of coordinate_of(). Effects of sensors and of the
/// table are left out, because they are no torque.
std::vector<LookAlike> look_alikes(const sim::DriveDescription& model, const RecordSet& set,
                                   const std::string& coordinate, double period);

/// "axis-likeness/1": { "over", "effects": [{ "kind", "title", "likeness" }] }, five at most.
nlohmann::json likeness_json(const ComparedModel& compared, const Focus& focus, const std::string& coordinate);

}  // namespace host
