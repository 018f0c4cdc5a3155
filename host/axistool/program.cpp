#include "host/axistool/program.hpp"

#include <glog/logging.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <CLI/CLI.hpp>
#include <cstdio>

#include "host/atomic_file.hpp"
#include "host/axistool/command_options.hpp"
#include "host/axistool/commands.hpp"
#include "host/exit_codes.hpp"

namespace axistool {

namespace {

/// Parses the command line and runs the command; returns the exit code.
int run(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const std::string first = argc > 1 ? argv[1] : "";
    if (error.get_exit_code() != 0 && app.get_subcommands().empty() && !first.empty() && !first.starts_with('-')) {
      std::fprintf(stderr, "axistool: %s\n", no_command(app, first).c_str());
      return static_cast<int>(host::ExitCode::usage);
    }
    const int code = app.exit(error);
    return code == 0 ? 0 : static_cast<int>(host::ExitCode::usage);
  } catch (const host::Failure& failure) {
    std::fprintf(stderr, "axistool: %s\n", failure.what());
    return static_cast<int>(failure.code);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "axistool: unexpected: %s\n", error.what());
    return static_cast<int>(host::ExitCode::bad_input);
  }
  return exit_status();
}

/// Keeps freed memory for the next matrix: giving it back and clearing new pages took a sixth of a quick diagnosis.
void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kLargestKept = 32 << 20, kMostKept = 256 << 20;  // bytes
  mallopt(M_MMAP_THRESHOLD, kLargestKept);
  mallopt(M_TRIM_THRESHOLD, kMostKept);
#endif
}

}  // namespace

int run_program(int argc, char** argv) {
  keep_freed_memory();
  FLAGS_minloglevel = google::GLOG_FATAL;  // Ceres would log rejected steps
  CLI::App app{"Identify feed drives, compare models with measurements, and find the physical effect that is missing."};
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done; 1 the answer is no; 2 usage; 3 no such device; 4 permission; 5 protocol or CRC;\n"
      "6 the device reports a fault; 7 time-out; 8 refused (safety, or too little excitation); 9 bad input file.");
  add_all_commands(app);
  app.parse_complete_callback([&app] { check_options(app); });
  const int status = run(app, argc, argv);
  try {
    host::finish_standard_output();
  } catch (const host::Failure& failure) {
    std::fprintf(stderr, "axistool: %s\n", failure.what());
    return status != 0 ? status : static_cast<int>(failure.code);
  }
  return status;
}

}  // namespace axistool
