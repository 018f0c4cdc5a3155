// Runs axistool as a user does.
#pragma once

#include "tests/run_program.hpp"

/// Runs axistool with `arguments` (one shell text). `streams` redirects, for example "2>/dev/null".
inline ProgramRun run_axistool(const std::string& arguments, const std::string& streams = "2>&1") {
  return run_program(std::string("\"") + AXISTOOL_PROGRAM + "\" " + arguments, streams);
}
