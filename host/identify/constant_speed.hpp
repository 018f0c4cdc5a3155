// Intervals of constant speed in a record, where friction shows without acceleration.
#pragma once

#include <vector>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Samples [begin, end) of a record in which the axis moves at one speed, transients left out.
struct ConstantSpeed {
  std::size_t begin = 0;
  std::size_t end = 0;
  double speed = 0.0;  ///< mean, rad/s or m/s, with its sign
};

struct ConstantSpeedOptions {
  double settle_s = 0.3;    ///< dropped at the start, as in the paper; at most half of a stretch
  double shortest_s = 0.3;  ///< a stretch must hold its speed for this long, the dropped part included
  double tolerance = 0.03;  ///< relative change of the smoothed speed that still counts as constant
};

/// Finds every stretch, in order of time, from the speed smoothed over 0.1 s (from the encoder where there is one).
std::vector<ConstantSpeed> find_constant_speeds(const Record& record, const sim::DataSheet& data,
                                                const ConstantSpeedOptions& options = {});

}  // namespace host
