// Option --device: selects a board and opens a link to it.
#pragma once

#include <memory>
#include <string>

#include "host/link/report_link.hpp"

namespace host {

/// "usb" or "usb:SERIAL", "sim" (the simulated board that `axistool sim` runs), "socket:PATH". Empty: the only board on
/// USB. Throws Failure: usage, no_such_device, permission.
std::unique_ptr<ReportLink> open_device(const std::string& device);

}  // namespace host
