// The README's workflow as one script: workflow.sh, beside this file.
#pragma once

#include <string>

#include "tests/run_program.hpp"

/// `device`: value for --device; `drive_case`: a folder of tests/data/drive-cases; `folder`: for the files of the
/// script.
inline ProgramRun run_workflow(const std::string& device, const std::string& drive_case, const std::string& folder) {
  const std::string script = AXIS_TEST_DATA "/../host/axistool/workflow.sh";
  return run_program("AXIS_DEVICE=" + device + " " + script + " " + AXISTOOL_PROGRAM + " " + drive_case + " " + folder);
}
