// The nonlinearity of a drive, even and odd apart, from the lines that a multisine leaves out.
#pragma once

#include <vector>

#include "host/response/frequency_response.hpp"
#include "host/response/periodic_run.hpp"

namespace host {

/// One value each for every gap between excited lines that has such a line in it. What the command holds there of
/// itself (a loop answers its own distortion) is taken off through `lines`, the response at the excited ones
/// (Pintelon & Schoukens, 2nd ed., 4.3.1.5); so is what noise leaves, of which periods tell the size. `channel`:
/// 0 position, 1 speed. `runs` is not empty, and all have the same period and lines.
struct Distortion {
  std::vector<DistortionLine> even, odd;
};
Distortion distortion_of(const std::vector<PeriodicRun>& runs, const std::vector<ResponseLine>& lines,
                         Eigen::Index channel);

}  // namespace host
