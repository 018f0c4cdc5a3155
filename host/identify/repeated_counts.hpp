// Where an axis moves by nearly a whole number of encoder counts a sample, the errors of successive counts are alike.
#pragma once

#include <span>
#include <vector>

namespace host {

/// Variance that a filter leaves of the errors of counts, over what it leaves of independent errors as in eq. (12). One
/// value a row, at least 1: only a known travel could make use of errors that cancel. The error of a count is a
/// sawtooth of the travel, so two readings that lie d counts apart have the correlation 1 - 6 f + 6 f^2, with the
/// fractional part f of d (second Bernoulli polynomial). Averaged over the filter's length: while the speed changes by
/// more than a count a sample, errors are independent.
///
/// `travel`: smoothed, one value a row. `step`: of the counts, > 0, in the same unit. `response`: of the filter to one
/// reading, a value a row.
std::vector<double> repeated_counts(std::span<const double> travel, double step, std::span<const double> response);

}  // namespace host
