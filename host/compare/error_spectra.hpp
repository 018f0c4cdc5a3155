// Shares of the error by frequency, and of the torque or force residual by period along the travel.
#pragma once

#include <vector>

#include "host/compare/comparison.hpp"
#include "host/compare/error_partition.hpp"

namespace host {

/// |DFT|^2 of the windows' errors by bands; by Parseval's theorem the bands' sums are the windows' squares.
Partition error_by_frequency(const sim::Drive& drive, const RecordSet& set);

/// Appends the strongest periods along the travel in the missing effort, as orders per turn where there is a turn, and
/// what has no period. Appends nothing where a record has no position or hardly moves.
void append_error_orders(const sim::DriveDescription& model, const RecordSet& set, std::vector<ErrorRegion>& regions);

}  // namespace host
