// Searches for one effect, then for a second one to add to the best, then for a third one to add to the best pair,
// while the residual requires it.
#pragma once

#include <vector>

#include "host/fit/prepared_sets.hpp"
#include "host/search/candidate_search.hpp"

namespace host {

/// Result of a search on prepared sets, each list best first.
struct Findings {
  std::vector<Candidate> singles;  ///< one effect added to the base
  std::vector<Candidate> pairs;    ///< a second one added to the best single
  /// A third effect added to the best pair, if the pair explains much but not enough. Also the remaining pair if the
  /// third effect makes one of the first two unnecessary.
  std::vector<Candidate> triples;
};

/// Searches in `sets`, whose noise floors become those of the best model at each step. Kinds in sets.absent are not
/// tried.
Findings search_by_steps(PreparedSets& sets, const ShareDone& progress, SearchEffort effort);

}  // namespace host
