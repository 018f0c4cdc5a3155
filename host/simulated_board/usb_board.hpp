// A simulated board as a real USB device of this computer, in real time.
#pragma once

#include <atomic>
#include <string>

#include "host/simulated_board/simulated_device.hpp"

namespace host {

/// Connects the board to the kernel's vhci-hcd with this serial number and serves it until `stop`, or until the
/// computer disconnects it. A restart of its program disconnects it briefly. Runs in real time; if the computer is too
/// slow, simulated time falls behind. Throws Failure: no_such_device without vhci-hcd or a free port, permission.
void serve_simulated_device_on_usb(SimulatedDevice& device, const std::string& serial_number,
                                   const std::atomic<bool>& stop);

}  // namespace host
