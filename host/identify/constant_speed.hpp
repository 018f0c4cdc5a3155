// Intervals of constant speed in a record, where friction can be measured without acceleration.
#pragma once

#include <vector>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Samples [begin, end) of a record with a constant speed, without transients.
struct ConstantSpeed {
  std::size_t begin = 0;
  std::size_t end = 0;
  double speed = 0.0;  ///< mean, rad/s or m/s, with its sign
};

struct ConstantSpeedOptions {
  double settle_s = 0.3;    ///< removed at the start, as in the paper; at most half of the interval
  double shortest_s = 0.3;  ///< shortest duration of a constant speed, including settle_s
  double tolerance = 0.03;  ///< largest relative change of the smoothed speed
};

/// Finds all intervals, in order of time, from the speed smoothed over 0.1 s (by the encoder if there is one).
std::vector<ConstantSpeed> find_constant_speeds(const Record& record, const sim::DataSheet& data,
                                                const ConstantSpeedOptions& options = {});

}  // namespace host
