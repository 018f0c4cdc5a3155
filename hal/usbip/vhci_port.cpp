#include "hal/usbip/vhci_port.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>

namespace hal::usbip {

namespace {

constexpr const char* kController = "/sys/devices/platform/vhci_hcd.0/";

// drivers/usb/usbip/usbip_common.h and linux/usb/ch9.h.
constexpr int kPortIsFree = 4;
constexpr int kFullSpeed = 2;
constexpr int kDeviceIdentifier = 1 << 16 | 2;  // bus and device number of a real server; any value works

[[noreturn]] void fail(int code, const std::string& what) {
  throw std::system_error(code, std::generic_category(), what);
}

/// Lines of `status`: hub, port, state, ...; hub "hs" is that for all but the fastest speeds.
int free_port() {
  std::ifstream status(std::string(kController) + "status");
  if (!status) fail(ENODEV, "the kernel's module vhci-hcd is not loaded (modprobe vhci-hcd)");
  for (std::string line; std::getline(status, line);) {
    std::istringstream words(line);
    std::string hub;
    int port = 0, state = 0;
    if (words >> hub >> port >> state && hub == "hs" && state == kPortIsFree) return port;
  }
  fail(EBUSY, "all ports of vhci-hcd are taken");
}

}  // namespace

int plug_into_vhci() {
  const int port = free_port();
  const std::string attach = std::string(kController) + "attach";
  const int file = open(attach.c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) fail(errno, attach);
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) fail(errno, "no pair of sockets");
  const std::string request = std::to_string(port) + " " + std::to_string(ends[0]) + " " +
                              std::to_string(kDeviceIdentifier) + " " + std::to_string(kFullSpeed);
  const bool attached = write(file, request.data(), request.size()) == static_cast<ssize_t>(request.size());
  const int why = errno;
  close(file);
  close(ends[0]);  // the kernel keeps its own reference
  if (!attached) {
    close(ends[1]);
    fail(why, attach + ": port " + std::to_string(port));
  }
  return ends[1];
}

}  // namespace hal::usbip
