// Runs a program as a user does, and keeps what it prints.
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

struct ProgramRun {
  int exit_code = -1;
  std::string output;  ///< standard output and standard error as they came
};

/// Runs one line of shell. `streams` redirects, for example "2>/dev/null".
inline ProgramRun run_program(const std::string& line, const std::string& streams = "2>&1") {
  ProgramRun run;
  std::FILE* pipe = ::popen((line + " " + streams).c_str(), "r");
  if (pipe == nullptr) return run;
  std::array<char, 4096> buffer{};
  for (std::size_t got = 0; (got = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    run.output.append(buffer.data(), got);
  const int status = ::pclose(pipe);
  if (WIFEXITED(status)) run.exit_code = WEXITSTATUS(status);
  return run;
}
