// Runs another program and keeps what it prints.
#pragma once

#include <string>
#include <vector>

#include "host/device/flash_sequence.hpp"

namespace host {

/// Waits for the end. Output and errors come together; `show` passes them on to standard error as they come.
CommandResult run_command(const std::vector<std::string>& command, bool show);

}  // namespace host
