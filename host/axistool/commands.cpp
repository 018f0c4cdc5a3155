#include "host/axistool/commands.hpp"

namespace axistool {

namespace {
host::ExitCode ending = host::ExitCode::done;
}

void end_with(host::ExitCode code) { ending = code; }

int exit_status() { return static_cast<int>(ending); }

void add_all_commands(CLI::App& app) {
  add_import(app);
  add_identify(app);
  add_friction(app);
  add_design(app);
  add_compare(app);
  add_diagnose(app);
  add_add(app);
  add_improve(app);
  add_scoreboard(app);
  add_effects(app);
  add_demo(app);
  add_flash(app);
  add_info(app);
  add_udev_rule(app);
  add_parameters(app);
}

}  // namespace axistool
