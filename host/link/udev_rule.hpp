// The udev rule that lets users other than root open a board.
#pragma once

#include <string>

namespace host {

inline constexpr const char* kUdevRuleFile = "/etc/udev/rules.d/70-axis.rules";
inline constexpr const char* kInstallUdevRule = "sudo axistool udev-rule --install";

/// Gives access by hidraw and by libusb to the group plugdev and to the user logged in at the computer.
std::string udev_rule();

/// Writes the rule and makes udev apply it to connected boards. Throws Failure(permission) if the user lacks the
/// rights.
void install_udev_rule();

}  // namespace host
