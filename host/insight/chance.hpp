// Could an improvement be luck?
#pragma once

#include "host/insight/comparison.hpp"

namespace host {

/// Probability, by a bootstrap over blocks of consecutive windows, that `after` is better than `before` on records of
/// the same kind: the part of resampled sets in which the summed squared error falls. Both must come from the same set.
double confidence_of_improvement(const SetError& before, const SetError& after);

}  // namespace host
