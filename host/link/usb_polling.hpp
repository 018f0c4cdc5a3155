// Makes Linux poll boards permanently. Otherwise each opening by hidraw waits 50 ms for old events (usbhid_open() in
// drivers/hid/usbhid/hid-core.c). Reports of an axis board carry numbers and need no wait.
#pragma once

#include <string>

namespace host {

inline constexpr const char* kUsbPollingFile = "/etc/modprobe.d/axis.conf";

/// The line of kUsbPollingFile: HID_QUIRK_ALWAYS_POLL (include/linux/hid.h) for axis boards.
std::string usb_polling_options();

/// Whether the loaded usbhid has this option; false if that is unknown.
bool usb_polls_always();

/// Writes the file, which takes effect when Linux next loads usbhid. Throws Failure (permission) if the user lacks the
/// rights.
void install_usb_polling();

}  // namespace host
