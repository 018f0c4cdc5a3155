// Shares of the error by frequency, and of the torque or force residual by period along the travel.
#pragma once

#include <vector>

#include "host/compare/comparison.hpp"
#include "host/compare/error_partition.hpp"

namespace host {

/// |DFT|^2 of the windows' errors in bands. By Parseval's theorem, the sum over the bands is the squared error.
Partition error_by_frequency(const sim::Drive& drive, const RecordSet& set);

/// Appends the strongest periods of the torque or force residual along the travel (as orders per turn of the shaft, if
/// there is one), and the aperiodic part. Appends nothing if a record has no position or hardly moves.
void append_error_orders(const sim::DriveDescription& model, const RecordSet& set, std::vector<ErrorRegion>& regions);

}  // namespace host
