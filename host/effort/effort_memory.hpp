// The memory: smooth functions of each coordinate. They model the part of the residual that no effect explains (model
// discrepancy).
#pragma once

#include <vector>

#include "host/effort/effort_rows.hpp"
#include "host/infer/evidence.hpp"

namespace host {

/// Splits the rows into runs of consecutive rows of one record.
std::vector<RowRun> runs_of(const EffortRows& rows);

/// Hat functions over speed by direction, position, friction over position, travel since the last reversal, friction
/// over time and load (`explained`, Nm or N), and a level for each record. `usual`: the drive's Coulomb level, Nm or N.
Memory effort_memory(const EffortRows& rows, const Eigen::VectorXd& explained, double usual);

}  // namespace host
