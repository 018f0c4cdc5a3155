// How Linux polls boards. Unless told to poll a HID device always, it waits 50 ms at each opening by hidraw, for events
// from before (usbhid_open() in drivers/hid/usbhid/hid-core.c); reports of an axis board carry numbers and need no
// wait.
#pragma once

#include <string>

namespace host {

inline constexpr const char* kUsbPollingFile = "/etc/modprobe.d/axis.conf";

/// The line of kUsbPollingFile: HID_QUIRK_ALWAYS_POLL (include/linux/hid.h) for axis boards.
std::string usb_polling_options();

/// Whether the usbhid that is loaded has been given that option; false where it cannot be told.
bool usb_polls_always();

/// Writes the file, which holds from the next time that Linux loads usbhid. Throws Failure (permission) when it may
/// not.
void install_usb_polling();

}  // namespace host
