// Tries effects of the catalogue on a model: fits each with all parameters free and measures its gain.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "host/compare/comparison.hpp"
#include "sim/effect.hpp"

namespace host {

/// A fitted model with effects added to a base, and its errors.
struct Candidate {
  std::vector<std::string> kinds;  ///< what was added to the base, in the order of the search
  sim::DriveDescription model;
  SetError training;
  SetError validation;

  /// Error relative to the base, product of training and validation: a real effect lowers both, a chance fit only one.
  double left = 1.0;
};

/// Called with the share of the work that is done, 0..1, from any thread.
using ShareDone = std::function<void(double)>;

/// One part of several that follow one another.
ShareDone part_of(const ShareDone& progress, double from, double to);

/// Windows for a first look, for a serious fit and for the last word.
struct SearchEffort {
  std::size_t coarse_windows = 80;
  std::size_t medium_windows = 200;
  std::size_t final_windows = 600;
  std::size_t finalists = 4;
  /// As many samples for windows of another length.
  SearchEffort over(double window_s) const;

  const sim::DriveDescription* nominal = nullptr;    ///< the model as it was given, another start for its parameters
  const std::vector<std::string>* absent = nullptr;  ///< kinds that are no candidates
  std::vector<std::string>* cut_short = nullptr;     ///< takes the kinds of which a fit ended at its budget
};

/// Fits `model` with each applicable effect added; `kinds` are those it already has beyond the base. Candidates without
/// gain on a few windows are not fitted further. Sorted by remaining error, best first.
std::vector<Candidate> search_candidates(const sim::DriveDescription& model, const std::vector<std::string>& kinds,
                                         const RecordSet& training, const RecordSet& validation,
                                         const ShareDone& progress = {}, const SearchEffort& effort = {});

/// The same for some effects only; each must be applicable.
std::vector<Candidate> search_kinds(const std::vector<const sim::EffectInfo*>& infos,
                                    const sim::DriveDescription& model, const std::vector<std::string>& kinds,
                                    const RecordSet& training, const RecordSet& validation,
                                    const ShareDone& progress = {}, const SearchEffort& effort = {});

/// A model measured on both sets as it stands, against the base that it extends.
Candidate judged(const std::vector<std::string>& kinds, const sim::DriveDescription& model,
                 const sim::DriveDescription& base, const RecordSet& training, const RecordSet& validation);

/// Fits the base from several starts, because a refit stuck in a local minimum causes false discoveries.
sim::DriveDescription fit_base(const sim::DriveDescription& given, const RecordSet& training);

}  // namespace host
