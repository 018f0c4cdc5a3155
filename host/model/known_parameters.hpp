// Prior knowledge of a drive: parameters that a fit holds, or that have a prior.
#pragma once

#include <string>
#include <vector>

#include "sim/drive_description.hpp"

namespace host {

/// The model with the parameters in `held` held, and with a prior for those in `believed`, each "KEY=DEVIATION". A key
/// is that of the model file ("J_kg_m2"), preceded by its effect ("cogging.period_mm") if several effects have it.
/// Throws Failure(usage) if the model does not have a key, or if a standard deviation is not positive.
sim::DriveDescription with_knowledge(sim::DriveDescription model, const std::vector<std::string>& held,
                                     const std::vector<std::string>& believed);

/// The model with other values, each "NAME=VALUE". A name is a key as above, or the name of the parameter without its
/// unit ("cogging.cosine_72"). Throws Failure(usage) for a name that the model does not have, or a value outside the
/// physical bounds of the parameter.
sim::DriveDescription with_values(sim::DriveDescription model, const std::vector<std::string>& values);

}  // namespace host
