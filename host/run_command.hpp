// Runs another program and keeps what it prints.
#pragma once

#include <string>
#include <vector>

namespace host {

struct CommandResult {
  int status = 0;  ///< exit status; 127 if the program does not exist
  std::string output;
};

/// Waits for the end. Output and errors come together; `show` passes them on to standard error as they come.
CommandResult run_command(const std::vector<std::string>& command, bool show);

}  // namespace host
