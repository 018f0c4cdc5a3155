// Even and odd nonlinearity of a drive, from the lines that a multisine does not excite.
#pragma once

#include <vector>

#include "host/response/frequency_response.hpp"
#include "host/response/periodic_run.hpp"

namespace host {

/// One value for each gap between excited lines that contains such a line. The command's own content there (a loop
/// responds to its own distortion) is subtracted by means of `lines`, the response at the excited lines (Pintelon &
/// Schoukens, 2nd ed., 4.3.1.5), and so is the noise, estimated from the periods. `channel`: 0 position, 1 speed.
/// `runs` is not empty, and all have the same period and lines.
struct Distortion {
  std::vector<DistortionLine> even, odd;
};
Distortion distortion_of(const std::vector<PeriodicRun>& runs, const std::vector<ResponseLine>& lines,
                         Eigen::Index channel);

}  // namespace host
