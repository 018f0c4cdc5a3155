// axistool udev-rule: prints or installs the rule that lets users open a board.
#include <fmt/format.h>

#include <memory>

#include "host/axistool/commands.hpp"
#include "host/link/udev_rule.hpp"
#include "host/link/usb_polling.hpp"

namespace axistool {

void add_udev_rule(CLI::App& app) {
  auto install = std::make_shared<bool>(false), poll_always = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("udev-rule", "print or install the rule that lets users open a board");
  command->add_flag("--install", *install, fmt::format("write it to {} and apply it (as root)", host::kUdevRuleFile));
  command->add_flag("--poll-always", *poll_always,
                    fmt::format("instead of the rule: the line of {} that avoids the 50 ms wait when Linux opens a "
                                "board over hidraw; effective once usbhid is reloaded (restart)",
                                host::kUsbPollingFile));
  command->footer(
      "Examples:\n"
      "  axistool udev-rule\n"
      "  sudo axistool udev-rule --install\n"
      "  sudo axistool udev-rule --poll-always --install\n"
      "Exit codes: 4 no permission to install it.");
  command->callback([install, poll_always] {
    if (!*install) {
      fmt::print("{}", *poll_always ? host::usb_polling_options() : host::udev_rule());
      return;
    }
    if (*poll_always) {
      host::install_usb_polling();
      fmt::print("{} is written; it takes effect once usbhid is reloaded: restart the computer\n",
                 host::kUsbPollingFile);
      return;
    }
    host::install_udev_rule();
    fmt::print("{} is written and applied: the group plugdev and the user at the computer may open boards\n",
               host::kUdevRuleFile);
  });
}

}  // namespace axistool
