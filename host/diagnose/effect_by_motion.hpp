// The best fit of one given effect to the motion.
#pragma once

#include <optional>

#include "host/fit/prepared_sets.hpp"
#include "host/record/measurements.hpp"
#include "host/search/candidate_search.hpp"

namespace host {

struct EffectByMotion {
  PreparedSets sets;  ///< those that the fit used
  Candidate best;
};

/// Adds one effect to a model and fits both to the motion over windows of kWindow_s; on a machine limited by model
/// error again as rough_measure() and rough_window_s() say. `fitted`: the sets of this model, with their base fitted.
/// `balance`: the force balance that tried this effect beside the model; its fit is a further start.
/// Empty if no starting value lowers the error. Throws Failure(refused) if the axis moves too little, Failure(usage) if
/// the effect cannot be added to this model.
std::optional<EffectByMotion> fit_effect_by_motion(const sim::EffectInfo& effect, const sim::DriveDescription& model,
                                                   const Measurements& measured, const PreparedSets& fitted,
                                                   const EffortScreen* balance = nullptr);

}  // namespace host
