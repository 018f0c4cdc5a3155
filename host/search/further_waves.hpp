// Further waves of a periodic effect: a ball screw, a cogging or an encoder disc has several periods at once.
#pragma once

#include <string>
#include <vector>

#include "host/fit/prepared_sets.hpp"
#include "host/search/candidate_search.hpp"

namespace host {

/// Adds waves of the candidate's last effect while something is left to explain and they predict the held-back windows
/// better than chance (kMostLuck). Each round adds the strongest waves in the residual of the training records at once,
/// each with a period of its own. Leaves a candidate whose last effect has no period as it is.
void add_further_waves(Candidate& candidate, const PreparedSets& sets);

/// Holds the further waves of these kinds, which were added to a base, in all fits, so that dozens of parameters do not
/// slow down the search for the next effect; or frees them.
void hold_further_waves(sim::DriveDescription& model, const sim::DriveDescription& base,
                        const std::vector<std::string>& kinds, bool held);

}  // namespace host
