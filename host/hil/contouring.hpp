// Contouring runs (section 4 of the paper): both axes along a path, and their contour error.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "host/hil/machine.hpp"
#include "host/hil/path.hpp"
#include "host/hil/recorder.hpp"

namespace host {

struct ContouringRun {
  std::vector<double> t_s;
  std::array<Record, hal::kAxisCount> records;
  std::array<std::vector<double>, hal::kAxisCount> tracking_um;  ///< reference minus encoder
  std::vector<double> contour_um;  ///< distance of the encoders' point from the path, >= 0; 0 before and after the path
  double begin_s = 0.0;            ///< beginning of the motion along the path
  double end_s = 0.0;

  double worst_tracking_um(std::size_t axis) const;  ///< largest error while following the path
  double worst_contour_um() const;
  double standing_before_um() const;  ///< larger error of both axes, at rest before the path
  double standing_after_um() const;
};

/// Enables the machine, moves both axes by `approach_mm` and back as on a machine in use, rests for 0.4 s, follows the
/// path, rests again. Throws Failure(device_fault) naming the fault if an axis stops.
ContouringRun run_contour(const std::array<MachineAxis, hal::kAxisCount>& axes, const Path& path,
                          const PathLimits& limits, std::uint64_t seed, double approach_mm = 2.0);

}  // namespace host
