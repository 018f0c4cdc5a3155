#include "host/link/open_device.hpp"

#include <fmt/format.h>

#include "host/exit_codes.hpp"
#include "host/link/socket_link.hpp"
#include "host/link/usb_boards.hpp"

namespace host {

std::unique_ptr<ReportLink> open_device(const std::string& device) {
  const auto rest_after = [&](std::string_view prefix) { return device.substr(prefix.size()); };
  if (device.empty() || device == "usb") return open_usb_board("");
  if (device.starts_with("usb:")) return open_usb_board(rest_after("usb:"));
  if (device == "sim") return connect_to_socket(default_socket_path());
  if (device.starts_with("socket:")) return connect_to_socket(rest_after("socket:"));
  throw Failure(
      ExitCode::usage,
      fmt::format("--device {}: write usb:SERIAL, sim or socket:PATH; `axistool list` shows the connected boards",
                  device));
}

}  // namespace host
