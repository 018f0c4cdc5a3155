// Linux' virtual USB host controller, vhci-hcd: ports of this computer into which a program can plug itself.
#pragma once

#include <string>

namespace hal::usbip {

/// Plugs in a full-speed device; returns the socket at which it must be served. Throws std::system_error: ENODEV
/// without the module, EACCES without the right (root's) to use it, EBUSY when all ports are taken.
int plug_into_vhci();

}  // namespace hal::usbip
