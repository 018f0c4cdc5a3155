// The udev rule that lets users other than root open a board.
#pragma once

#include <string>

namespace host {

inline constexpr const char* kUdevRuleFile = "/etc/udev/rules.d/70-axis.rules";
inline constexpr const char* kInstallUdevRule = "sudo axistool udev-rule --install";

/// For hidraw and for libusb: the group plugdev, and the user at the computer's screen.
std::string udev_rule();

/// Writes the rule and makes udev apply it to connected boards. Throws Failure(permission) without the rights for it.
void install_udev_rule();

}  // namespace host
