// The commands of axistool. Each lives in a file of its own, which parses options and prints; the work is in the
// library.
#pragma once

#include <CLI/CLI.hpp>

#include "host/exit_codes.hpp"

namespace axistool {

/// Registers every command with the program's option parser.
void add_all_commands(CLI::App& app);

void add_import(CLI::App& app);
void add_identify(CLI::App& app);
void add_friction(CLI::App& app);
void add_design(CLI::App& app);
void add_effects(CLI::App& app);
void add_demo(CLI::App& app);
void add_flash(CLI::App& app);
void add_info(CLI::App& app);
void add_udev_rule(CLI::App& app);
void add_parameters(CLI::App& app);
void add_compare(CLI::App& app);
void add_diagnose(CLI::App& app);
void add_improve(CLI::App& app);
void add_add(CLI::App& app);
void add_scoreboard(CLI::App& app);

/// Called by a command that ran to its end but whose answer is not "done" (for example ExitCode::answer_is_no).
void end_with(host::ExitCode code);

/// What the process returns when no failure was thrown.
int exit_status();

}  // namespace axistool
