// A simulated board as a real USB device of this computer, in real time.
#pragma once

#include <atomic>
#include <string>

#include "host/simulated_board/simulated_device.hpp"

namespace host {

/// Plugs the board into the kernel's vhci-hcd under this serial number and serves it until `stop`, or until the
/// computer lets go of it; a restart of its program unplugs it for a moment. Control periods keep real time; where the
/// computer cannot, simulated time falls behind. Throws Failure: no_such_device without vhci-hcd or a free port,
/// permission.
void serve_simulated_device_on_usb(SimulatedDevice& device, const std::string& serial_number,
                                   const std::atomic<bool>& stop);

}  // namespace host
