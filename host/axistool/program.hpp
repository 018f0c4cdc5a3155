// axistool: one file per command; this one lists the commands and maps failures to exit codes.
#pragma once

namespace axistool {

/// Runs the command that the arguments name; returns the exit code.
int run_program(int argc, char** argv);

}  // namespace axistool
