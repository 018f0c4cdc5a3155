#include "host/link/udev_rule.hpp"

#include <fmt/format.h>

#include "hal/usb_identity.hpp"
#include "host/atomic_file.hpp"
#include "host/exit_codes.hpp"
#include "host/run_command.hpp"

namespace host {

std::string udev_rule() {
  const std::string board =
      fmt::format(R"(ATTRS{{idVendor}}=="{:04x}", ATTRS{{idProduct}}=="{:04x}")", hal::kUsbVendor, hal::kUsbProduct);
  const std::string access = R"(MODE="0660", GROUP="plugdev", TAG+="uaccess")";
  return fmt::format(
      "# Axis boards: access for the group plugdev and for the user at the computer.\n"
      "SUBSYSTEM==\"hidraw\", {0}, {1}\n"
      "SUBSYSTEM==\"usb\", ENV{{DEVTYPE}}==\"usb_device\", {0}, {1}\n",
      board, access);
}

void install_udev_rule() {
  try {
    write_file_atomically(kUdevRuleFile, udev_rule());
  } catch (const std::exception& error) {
    throw Failure(ExitCode::permission, fmt::format("{}; as root: {}", error.what(), kInstallUdevRule));
  }
  for (const auto& command : {std::vector<std::string>{"udevadm", "control", "--reload"},
                              std::vector<std::string>{"udevadm", "trigger", "--subsystem-match=hidraw",
                                                       "--subsystem-match=usb", "--action=add"}}) {
    const CommandResult result = run_command(command, false);
    if (result.status != 0)
      throw Failure(ExitCode::permission, fmt::format("{} is written, but udevadm failed (plug the board in again): {}",
                                                      kUdevRuleFile, result.output));
  }
}

}  // namespace host
