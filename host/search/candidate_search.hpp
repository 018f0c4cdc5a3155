// Tries effects of the catalogue on a model: fits each with all parameters free and measures its gain.
#pragma once

#include <string>
#include <vector>

#include "host/compare/comparison.hpp"
#include "host/effort/effort_screen.hpp"
#include "host/fit/fit_budget.hpp"
#include "host/share_done.hpp"
#include "sim/effect.hpp"

namespace host {

/// A fitted model with effects added to a base, and its errors.
struct Candidate {
  std::vector<std::string> kinds;  ///< the effects added to the base, in the order of the search
  sim::DriveDescription model;
  SetError training;    ///< over the model's own noise floors
  SetError validation;  ///< over the model's own noise floors

  /// Both sets count alike: a real effect predicts both better, a chance fit only one.
  double log_loss() const { return training.log_loss + validation.log_loss; }
};

struct SearchEffort {
  WindowCounts windows = {};
  std::size_t finalists = 4;
  const sim::DriveDescription* nominal = nullptr;    ///< the given model: its base parameters are a further start
  const EffortScreen* balance = nullptr;             ///< force balance: its fitted models are further starts
  const std::vector<std::string>* absent = nullptr;  ///< kinds that are no candidates
  std::vector<std::string>* cut_short = nullptr;     ///< receives the kinds for which a fit ended at its budget
};

/// Fits `model` with each applicable effect added. `kinds`: effects that the model already has beyond the base.
/// Candidates that gain nothing on a few windows are not fitted further. If an effect explains the records, others are
/// left out unless they may be confused with it and the force balance does not tell them from it; so are second masses
/// that the balance holds less probable than nothing. The result is sorted by log loss, best first.
std::vector<Candidate> search_candidates(const sim::DriveDescription& model, const std::vector<std::string>& kinds,
                                         const RecordSet& training, const RecordSet& validation,
                                         const ShareDone& progress = {}, const SearchEffort& effort = {});

/// The same for the given effects only, none of which is left out; each must be applicable.
std::vector<Candidate> search_kinds(const std::vector<const sim::EffectInfo*>& infos,
                                    const sim::DriveDescription& model, const std::vector<std::string>& kinds,
                                    const RecordSet& training, const RecordSet& validation,
                                    const ShareDone& progress = {}, const SearchEffort& effort = {});

/// A fitted model with its errors on both sets.
Candidate judged(const std::vector<std::string>& kinds, const sim::DriveDescription& model, const RecordSet& training,
                 const RecordSet& validation);

}  // namespace host
