// Runs axistool as a user does.
#pragma once

#include <string>

#include "tests/run_program.hpp"

/// A drive without a hidden effect: model.toml, train-jog.csv, train-sweep.csv, validate.csv.
inline const std::string kCase = AXIS_TEST_DATA "/drive-cases/none/case-00";

/// Runs axistool with `arguments` (one shell text). `streams` redirects, for example "2>/dev/null".
inline ProgramRun run_axistool(const std::string& arguments, const std::string& streams = "2>&1") {
  return run_program(std::string("\"") + AXISTOOL_PROGRAM + "\" " + arguments, streams);
}
