// The commands of axistool. Each has a separate file, which parses options and prints; the work is done in the library.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "host/exit_codes.hpp"

namespace axistool {

/// Registers every command with the program's option parser.
void add_all_commands(CLI::App& app);

void add_help(CLI::App& app);
void add_open(CLI::App& app);
void add_sheet(CLI::App& app);
void add_export(CLI::App& app);
void add_import(CLI::App& app);
void add_cut(CLI::App& app);
void add_shift(CLI::App& app);
void add_identify(CLI::App& app);
void add_friction(CLI::App& app);
void add_design(CLI::App& app);
void add_effects(CLI::App& app);
void add_demo(CLI::App& app);
void add_flash(CLI::App& app);
void add_update(CLI::App& app);
void add_info(CLI::App& app);
void add_list(CLI::App& app);
void add_get_params(CLI::App& app);
void add_set_params(CLI::App& app);
void add_diff_params(CLI::App& app);
void add_reset_params(CLI::App& app);
void add_save(CLI::App& app);
void add_backup(CLI::App& app);
void add_restore(CLI::App& app);
void add_enable(CLI::App& app);
void add_disable(CLI::App& app);
void add_home(CLI::App& app);
void add_jog(CLI::App& app);
void add_move(CLI::App& app);
void add_capture(CLI::App& app);
void add_excite(CLI::App& app);
void add_bode(CLI::App& app);
void add_run(CLI::App& app);
void add_circle(CLI::App& app);
void add_robustness(CLI::App& app);
void add_pitch(CLI::App& app);
void add_dial(CLI::App& app);
void add_faults(CLI::App& app);
void add_clear_faults(CLI::App& app);
void add_bench(CLI::App& app);
void add_doctor(CLI::App& app);
void add_sim(CLI::App& app);
void add_completion(CLI::App& app);
void add_man(CLI::App& app);
void add_udev_rule(CLI::App& app);
void add_hil(CLI::App& app);
void add_parameters(CLI::App& app);
void add_compare(CLI::App& app);
void add_adjust(CLI::App& app);
void add_diagnose(CLI::App& app);
void add_plan(CLI::App& app);
void add_improve(CLI::App& app);
void add_add(CLI::App& app);
void add_serve(CLI::App& app);
void add_scoreboard(CLI::App& app);
void add_commission(CLI::App& app);

/// All commands, sorted by name.
std::vector<const CLI::App*> commands_of(const CLI::App& app);

/// Error message for an unknown command, with the closest match.
std::string no_command(const CLI::App& app, const std::string& name);

/// Called by a command that ran to its end but whose answer is not "done" (for example ExitCode::answer_is_no).
void end_with(host::ExitCode code);

/// Exit code of the process if no failure was thrown.
int exit_status();

}  // namespace axistool
