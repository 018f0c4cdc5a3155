// axistool udev-rule: who may open a board.
#include <fmt/format.h>

#include <memory>

#include "host/axistool/commands.hpp"
#include "host/device/udev_rule.hpp"

namespace axistool {

void add_udev_rule(CLI::App& app) {
  auto install = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("udev-rule", "print or install the rule that lets users open a board");
  command->add_flag("--install", *install, fmt::format("write it to {} and apply it (as root)", host::kUdevRuleFile));
  command->footer(
      "Examples:\n"
      "  axistool udev-rule\n"
      "  sudo axistool udev-rule --install\n"
      "Exit codes: 4 no permission to install it.");
  command->callback([install] {
    if (!*install) {
      fmt::print("{}", host::udev_rule());
      return;
    }
    host::install_udev_rule();
    fmt::print("{} is written and applied: the group plugdev and the user at the computer may open boards\n",
               host::kUdevRuleFile);
  });
}

}  // namespace axistool
