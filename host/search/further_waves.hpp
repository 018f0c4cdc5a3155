// Further waves of a periodic effect: a ball screw, a cogging or an encoder disc has several periods at once.
#pragma once

#include "host/fit/prepared_sets.hpp"
#include "host/search/candidate_search.hpp"

namespace host {

/// Adds waves of the candidate's last effect while something is left to explain and they predict the held-back windows
/// better than chance (kMostLuck). Each round adds the strongest waves in the residual of the training records at once,
/// each with a period of its own. Leaves a candidate whose last effect has no period as it is.
void add_further_waves(Candidate& candidate, const PreparedSets& sets);

}  // namespace host
