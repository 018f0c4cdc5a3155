// A simulated board behind a local socket, in real time.
#pragma once

#include <atomic>

#include "host/link/socket_link.hpp"
#include "host/simulated_board/simulated_device.hpp"

namespace host {

/// Serves one host after the other at `listener` (listen_at_socket) until `stop`: a cable that is connected again by
/// each. Control periods keep real time; where the computer cannot, simulated time falls behind.
void serve_simulated_device(SimulatedDevice& device, const OwnedDescriptor& listener, const std::atomic<bool>& stop);

}  // namespace host
