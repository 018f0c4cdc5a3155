// Runs the program as a user does.
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

struct ProgramRun {
  int exit_code = -1;
  std::string output;  ///< standard output and standard error as they came
};

/// Runs axistool with `arguments` (one shell text). `streams` redirects, for example "2>/dev/null".
inline ProgramRun run_axistool(const std::string& arguments, const std::string& streams = "2>&1") {
  ProgramRun run;
  std::FILE* pipe = ::popen((std::string("\"") + AXISTOOL_PROGRAM + "\" " + arguments + " " + streams).c_str(), "r");
  if (pipe == nullptr) return run;
  std::array<char, 4096> buffer{};
  for (std::size_t got; (got = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    run.output.append(buffer.data(), got);
  const int status = ::pclose(pipe);
  if (WIFEXITED(status)) run.exit_code = WEXITSTATUS(status);
  return run;
}
