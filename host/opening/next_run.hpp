// What to record next, in the words of the controller that wrote a log.
#pragma once

#include <string>

#include "host/opening/understanding.hpp"

namespace host {

/// Empty where the log holds what a diagnosis needs: effort, motion, and 200 samples a second at least.
std::string next_run(const Understanding& understood);

}  // namespace host
