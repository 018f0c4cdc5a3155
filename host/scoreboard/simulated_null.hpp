// Simulated measurements of drives in which nothing is hidden, each with its own motion, noise and parameters: a
// diagnosis must not claim anything from them.
#pragma once

#include <cstdint>
#include <vector>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

struct SimulatedNull {
  sim::DriveDescription model;   ///< the engineer's model: up to 10 % off, as after a first identification
  std::vector<Record> train;     ///< one to three records of 3 to 10 s
  std::vector<Record> validate;  ///< empty for every other one
};

/// Equal arguments give equal measurements.
SimulatedNull simulated_null(std::uint64_t seed);

}  // namespace host
