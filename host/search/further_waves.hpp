// Further waves of a periodic effect: a ball screw, a cogging or an encoder disc has several periods at once.
#pragma once

#include "host/fit/prepared_sets.hpp"
#include "host/search/candidate_search.hpp"

namespace host {

/// Adds waves of the candidate's last effect, one at a time, while they leave something to explain and each predicts
/// the held-back windows better than chance (kMostLuck). Each is the strongest one in the residual of the training
/// records, as a further entry. Leaves a candidate whose last effect has no period as it is.
void add_further_waves(Candidate& candidate, const PreparedSets& sets);

}  // namespace host
