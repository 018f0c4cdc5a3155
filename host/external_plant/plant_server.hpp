// Simulated drives as the plant of another controller: the program's side of axis-plant/1.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <vector>

#include "sim/drive_description.hpp"

namespace host {

/// Sends the greeting, then answers line by line until the input ends, with the readings of each drive's encoder and
/// tachometer. Each drive starts at 0. `seed`: seed of the tachometers' noise. Throws Failure(protocol) for any other
/// line, or a greeting for another number of axes.
void serve_plant(const std::vector<sim::DriveDescription>& drives, std::uint64_t seed, std::istream& in,
                 std::ostream& out);

}  // namespace host
