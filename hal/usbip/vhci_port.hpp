// Linux' virtual USB host controller, vhci-hcd: virtual ports of this computer to which a program can connect a device.
#pragma once

#include <string>

namespace hal::usbip {

/// Connects a full-speed device; returns the socket at which it must be served. Throws std::system_error: ENODEV
/// without the module, EACCES without root's rights, EBUSY when all ports are taken.
int plug_into_vhci();

}  // namespace hal::usbip
