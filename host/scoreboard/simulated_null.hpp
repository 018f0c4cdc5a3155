// Simulated measurements of drives without a hidden effect, each with its own motion, noise and parameters. A diagnosis
// must not claim any effect on them.
#pragma once

#include <cstdint>
#include <vector>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

struct SimulatedNull {
  sim::DriveDescription model;   ///< the engineer's model, with errors of up to 10 %, as after a first identification
  std::vector<Record> train;     ///< one to three records of 3 to 10 s
  std::vector<Record> validate;  ///< empty for every second measurement
};

/// Equal arguments give equal measurements.
SimulatedNull simulated_null(std::uint64_t seed);

}  // namespace host
