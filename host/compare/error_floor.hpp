// Noise floor: the error of a perfect model. Sensor noise, quantisation, and the uncertainty of the restart state and
// of a measured torque or force, propagated through the model, window by window.
#pragma once

#include <vector>

#include "host/compare/prediction.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// RMS floors of one record, one element a window; a channel that the record lacks is empty.
struct ErrorFloor {
  std::vector<double> x;
  std::vector<double> w;
};

/// Computes the floors of every `stride`-th window; those of the others stay unchanged (0 if there were none). `drive`
/// must be that of the model.
void renew_floor(ErrorFloor& floor, const sim::DriveDescription& model, const sim::Drive& drive,
                 const PreparedRecord& prepared, std::size_t stride);

}  // namespace host
