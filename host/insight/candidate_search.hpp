// Tries effects of the catalogue on a model: fits each with all parameters free, and measures what it would bring.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "host/insight/comparison.hpp"

namespace host {

/// A model with one effect more, fitted.
struct Candidate {
  std::vector<std::string> kinds;  ///< what was added to the base, in the order of the search
  sim::DriveDescription model;
  double train = 0.0;   ///< combined error on the training windows that the last fit used
  SetError validation;  ///< on all validation windows
};

/// Called with the share of the work that is done, 0..1, from any thread.
using Progress = std::function<void(double)>;

/// Windows for a first look, for a serious fit and for the last word.
struct SearchEffort {
  std::size_t coarse_windows = 70;
  std::size_t medium_windows = 220;
  std::size_t finalists = 5;
};

/// Fits `model` with each applicable effect added; `kinds` are those it already has beyond the base. Candidates that
/// promise nothing on a few windows are not fitted further. Sorted by validation error, best first.
std::vector<Candidate> search_candidates(const sim::DriveDescription& model, const std::vector<std::string>& kinds,
                                         const RecordSet& training, const RecordSet& validation,
                                         const Progress& progress = {}, const SearchEffort& effort = {});

/// Fits a model that is a candidate already (a pair, or one to be fitted again) on all windows.
Candidate refine_candidate(const Candidate& candidate, const RecordSet& training, const RecordSet& validation);

/// Fits the base from several starts, since a re-fit that is stuck in a local minimum fakes discoveries.
sim::DriveDescription fit_base(const sim::DriveDescription& given, const RecordSet& training);

}  // namespace host
