// Noise floor: the error of a perfect model. It comes from sensor noise, quantisation, and the uncertainty of the
// restart state and of a measured torque or force, propagated through the model for each window.
#pragma once

#include <vector>

#include "host/compare/prediction.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// RMS noise floors of one record, one element per window. A channel that the record lacks is empty.
struct ErrorFloor {
  std::vector<double> x;
  std::vector<double> w;
};

/// Computes the noise floors of every `stride`-th window; the others keep their values (initially 0). `drive` must be
/// that of the model.
void renew_floor(ErrorFloor& floor, const sim::DriveDescription& model, const sim::Drive& drive,
                 const PreparedRecord& prepared, std::size_t stride);

}  // namespace host
