// One effect, a second on top of the best one, a third on top of the best two - as long as something is left to find.
#pragma once

#include <vector>

#include "host/diagnose/candidate_search.hpp"
#include "host/diagnose/prepared_sets.hpp"

namespace host {

/// What a search found on prepared sets, each list best first.
struct Findings {
  std::vector<Candidate> singles;  ///< one effect added to the base
  std::vector<Candidate> pairs;    ///< a second one added to the best single
  /// A third one added to the best pair, where that takes much and leaves much; and the triple without what the third
  /// one makes needless, which is a pair.
  std::vector<Candidate> triples;
};

/// Searches in `sets`, whose floors become those of the best model at each step; kinds in sets.absent are not tried.
Findings search_by_steps(PreparedSets& sets, const ShareDone& progress, SearchEffort effort);

}  // namespace host
