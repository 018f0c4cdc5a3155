// axistool: finds out how a drive really behaves. One file a command; this one lists them and maps failures to exit
// codes.
#include <glog/logging.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "host/axistool/commands.hpp"
#include "host/exit_codes.hpp"

int main(int argc, char** argv) {
  FLAGS_minloglevel = google::GLOG_FATAL;  // Ceres logs steps that it tried in vain
  CLI::App app{"Identify feed drives, compare models with measurements, and find the physical effect that is missing."};
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done; 1 the answer is no; 2 usage; 3 no such device; 4 permission; 5 protocol or CRC;\n"
      "6 the device reports a fault; 7 time-out; 8 refused for safety or for want of excitation; 9 bad input file.");
  axistool::add_all_commands(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return code == 0 ? 0 : static_cast<int>(host::ExitCode::usage);
  } catch (const host::Failure& failure) {
    std::fprintf(stderr, "axistool: %s\n", failure.what());
    return static_cast<int>(failure.code);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "axistool: unexpected: %s\n", error.what());
    return static_cast<int>(host::ExitCode::bad_input);
  }
  return axistool::exit_status();
}
