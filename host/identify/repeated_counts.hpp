// If an axis moves by nearly a whole number of encoder counts per sample, the errors of successive counts are alike.
#pragma once

#include <span>
#include <vector>

namespace host {

/// Variance that a filter leaves of the quantisation errors, relative to the variance for independent errors as in eq.
/// (12). One value per row, at least 1, because only a known travel could make use of errors that cancel. The error of
/// a count is a sawtooth over the travel. So two readings at a distance of d counts have the correlation 1 - 6 f + 6
/// f^2, with the fractional part f of d (second Bernoulli polynomial). Averaged over the length of the filter: if the
/// speed changes by more than a count per sample in this time, the errors are independent.
///
/// `travel`: smoothed, one value per row. `step`: size of a count, > 0, in the same unit. `response`: response of the
/// filter to one reading, one value per row.
std::vector<double> repeated_counts(std::span<const double> travel, double step, std::span<const double> response);

}  // namespace host
