// Runs another program and returns its output.
#pragma once

#include <string>
#include <vector>

namespace host {

struct CommandResult {
  int status = 0;  ///< exit status; 127 if the program does not exist
  std::string output;
};

/// Waits for the end. Output and errors are returned together; `show` also copies them to standard error as they
/// arrive.
CommandResult run_command(const std::vector<std::string>& command, bool show);

}  // namespace host
