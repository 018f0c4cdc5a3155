// Smooth functions of each coordinate, for the part of the residual that no effect explains.
#pragma once

#include <vector>

#include "host/effort/effort_rows.hpp"
#include "host/infer/evidence.hpp"

namespace host {

/// Consecutive rows of a record.
std::vector<RowRun> runs_of(const EffortRows& rows);

/// Hats over speed by direction, position, friction over position, travel since the last reversal, friction over time,
/// load (`explained`, Nm or N) and a level for each record. `usual`: the drive's Coulomb level, Nm or N.
Memory effort_memory(const EffortRows& rows, const Eigen::VectorXd& explained, double usual);

}  // namespace host
