// Significance of an improvement.
#pragma once

#include <cstddef>
#include <vector>

#include "host/compare/comparison.hpp"

namespace host {

/// Probability that `after` is better than `before` on records of the same kind: the share of resampled sets in which
/// the loss decreases. `before`, `after`: losses of the same windows, which add up. Bootstrap over blocks of `block`
/// consecutive windows, because neighbouring windows belong to the same motion.
double confidence_of_improvement(const std::vector<double>& before, const std::vector<double>& after,
                                 std::size_t block = 10);

/// Length of independent blocks, s. Each prediction restarts from the measurement, so errors do not carry over.
inline constexpr double kLuckBlock_s = kWindow_s;

/// Largest p-value of an improvement that is claimed.
inline constexpr double kMostLuck = 0.05;

/// Number of windows of a set in `span_s` of motion, at least 1.
std::size_t windows_in(double span_s, const RecordSet& set);

/// p-value of the best of `tried` candidates: probability of a gain as large as that of `after` by chance.
/// Randomisation test over the signs of the blocks' gains, times the number of candidates tried (Bonferroni), at most
/// 1.
double probability_of_luck(const std::vector<double>& before, const std::vector<double>& after, std::size_t tried,
                           std::size_t block);
/// The same from the errors of two models on `set`, in blocks of kLuckBlock_s.
double probability_of_luck(const SetError& before, const SetError& after, std::size_t tried, const RecordSet& set);

}  // namespace host
