// Could an improvement be luck?
#pragma once

#include "host/compare/comparison.hpp"

namespace host {

/// Probability, by a bootstrap over blocks of `block` consecutive windows, that `after` is better than `before` on
/// records of the same kind: the part of resampled sets in which the error that a fit minimises falls. Errors of
/// neighbouring windows belong to the same motion. Both errors must come from the same set.
double confidence_of_improvement(const SetError& before, const SetError& after, std::size_t block = 10,
                                 double common_square = kCommonSquare);

}  // namespace host
