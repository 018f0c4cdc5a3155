// A simulated board behind a local socket, in real time.
#pragma once

#include <atomic>

#include "host/link/socket_link.hpp"
#include "host/simulated_board/simulated_device.hpp"

namespace host {

/// Serves hosts at `listener` (listen_at_socket) until `stop`; the cable is connected while there is a host. Runs in
/// real time; if the computer is too slow, simulated time falls behind.
void serve_simulated_device(SimulatedDevice& device, const OwnedDescriptor& listener, const std::atomic<bool>& stop);

}  // namespace host
