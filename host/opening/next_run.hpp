// Recommends the next recording, in the terms of the controller that wrote the log.
#pragma once

#include <string>

#include "host/opening/understanding.hpp"

namespace host {

/// Empty if the log suffices for a diagnosis: torque or current, motion, and at least 200 samples per second.
std::string next_run(const Understanding& understood);

}  // namespace host
