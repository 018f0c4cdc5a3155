// Prior knowledge of a drive: parameters that a fit holds, or that have a prior.
#pragma once

#include <string>
#include <vector>

#include "sim/drive_description.hpp"

namespace host {

/// The model with the parameters named in `held` held, and with a belief in those of `believed`, each "KEY=DEVIATION".
/// A key is that of the model file ("J_kg_m2"), with its effect before it ("cogging.period_mm") where several effects
/// have it. Throws Failure(usage) for a key that the model does not hold, and where the standard deviation is not
/// positive.
sim::DriveDescription with_knowledge(sim::DriveDescription model, const std::vector<std::string>& held,
                                     const std::vector<std::string>& believed);

/// The model with other values, each "NAME=VALUE": a key as above, or the parameter's name without its unit
/// ("cogging.cosine_72"). Throws Failure(usage) for a name that the model does not hold, and for a value outside the
/// parameter's physical bounds.
sim::DriveDescription with_values(sim::DriveDescription model, const std::vector<std::string>& values);

}  // namespace host
