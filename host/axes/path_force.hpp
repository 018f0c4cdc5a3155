// The process force along a path.
#pragma once

#include <vector>

#include "host/device/path_run.hpp"
#include "host/identify/force_estimate.hpp"

namespace host {

/// The model of an axis, and the estimator of the board, Kobs.
struct PathForceModel {
  sim::DriveDescription model;
  Eigen::Matrix<double, 3, Eigen::Dynamic> Kobs;
};

/// Adds the process force of the first axes, as many as there are models, to the record of a path. The columns are
/// those of add_process_force(), for further axes with the axis's name in front: process_force_N, y_process_force_N.
/// Their force must be in the capture.
void add_path_forces(Record& record, const PathCapture& capture, const PathBoard& board,
                     const std::vector<PathForceModel>& models);

}  // namespace host
