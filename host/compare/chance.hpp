// Could an improvement be luck?
#pragma once

#include "host/compare/comparison.hpp"

namespace host {

/// Probability, by a bootstrap over blocks of `block` consecutive windows, that `after` is better than `before` on
/// records of the same kind: the part of resampled sets in which the error that a fit minimises falls. Errors of
/// neighbouring windows belong to the same motion. Both errors must come from the same set.
double confidence_of_improvement(const SetError& before, const SetError& after, std::size_t block = 10,
                                 double common_square = kCommonSquare);

/// Windows of so long a time are taken to be lucky or not on their own, s: each prediction restarts from the
/// measurement, so that none carries on what went wrong in the one before.
inline constexpr double kLuckBlock_s = kWindow_s;

/// Probability that the best of `tried` candidates lowers the error as much as `after` does although each gains and
/// loses by chance: the part of random signs of the blocks' gains that sum to as much (a randomisation test), times
/// the number tried (Bonferroni), at most 1.
double probability_of_luck(const SetError& before, const SetError& after, std::size_t tried, std::size_t block,
                           double common_square = kCommonSquare);

}  // namespace host
