// Starts of the fits of an effect: from the catalogue, a scan or the force balance.
#pragma once

#include <cmath>
#include <vector>

#include "host/fit/model_fit.hpp"
#include "sim/effect.hpp"

namespace host {

/// A base with an effect as its last one.
struct Start {
  const sim::EffectInfo* info;
  sim::DriveDescription model;
  double error = HUGE_VAL;                         ///< error relative to the base's
  bool scanned = false;                            ///< the best of many starts, found by a scan
  bool balanced = false;                           ///< fitted by the force balance
  bool cut_short = false;                          ///< a fit ended at its budget
  sim::EffectEntry effect = model.effects.back();  ///< before any fit

  /// Takes over the result of a fit.
  void take(const FitResult& fit) {
    model = fit.model;
    cut_short = cut_short || fit.cut_short;
  }
};

/// Noise floors depend on the model that propagates the uncertainty of a restart. A model with presliding, a second
/// mass or a gap propagates it differently from the base, so such a candidate and the base are compared over the
/// candidate's own noise floors. It also needs many small integration steps.
bool needs_own_floors(const sim::DriveDescription& model);

/// The set with the noise floors over which a model is compared.
RecordSet suited_to(const sim::DriveDescription& model, const RecordSet& shared);

/// Fits a start on a set and stores its error relative to the base.
void fit_start(Start& start, const sim::DriveDescription& base, const RecordSet& shared, double base_error,
               const FitOptions& options);

/// The starts from which effects are fitted: those of an effect with many parameters are scanned and only the best
/// remain, perhaps none. Each way to share friction between motor and load is scanned separately, so that each is
/// fitted. `effects`: the starts of each.
std::vector<Start> chosen_starts(const std::vector<std::vector<Start>>& effects, const sim::DriveDescription& base,
                                 const RecordSet& set);

/// Fits the parameters of the effect alone, with at most the windows that `budget` allows, and stores the error
/// relative to the base. A model that contains the base cannot be worse than the base, but a fit of all parameters may
/// end there.
void fit_own_size(Start& start, const sim::DriveDescription& base, const RecordSet& shared, const FitOptions& budget);

/// Keeps the two best starts of each effect, and the best one of each way to share friction between motor and load.
/// Starts of the force balance do not count. `starts`: in the order of their errors.
void keep_best(std::vector<Start>& starts);

}  // namespace host
