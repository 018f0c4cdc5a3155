#include "host/axistool/commands.hpp"

namespace axistool {

namespace {
host::ExitCode status_at_end = host::ExitCode::done;
}

void end_with(host::ExitCode code) { status_at_end = code; }

int exit_status() { return static_cast<int>(status_at_end); }

void add_all_commands(CLI::App& app) {
  add_open(app);
  add_sheet(app);
  add_import(app);
  add_cut(app);
  add_shift(app);
  add_identify(app);
  add_friction(app);
  add_design(app);
  add_compare(app);
  add_diagnose(app);
  add_plan(app);
  add_add(app);
  add_adjust(app);
  add_improve(app);
  add_serve(app);
  add_export(app);
  add_scoreboard(app);
  add_commission(app);
  add_effects(app);
  add_demo(app);
  add_flash(app);
  add_update(app);
  add_info(app);
  add_list(app);
  add_hil(app);
  add_parameters(app);
  add_get_params(app);
  add_set_params(app);
  add_diff_params(app);
  add_reset_params(app);
  add_save(app);
  add_backup(app);
  add_restore(app);
  add_enable(app);
  add_disable(app);
  add_home(app);
  add_jog(app);
  add_move(app);
  add_capture(app);
  add_excite(app);
  add_bode(app);
  add_run(app);
  add_circle(app);
  add_robustness(app);
  add_pitch(app);
  add_dial(app);
  add_faults(app);
  add_clear_faults(app);
  add_bench(app);
  add_doctor(app);
  add_sim(app);
  add_completion(app);
  add_man(app);
  add_udev_rule(app);
  add_help(app);
}

}  // namespace axistool
