#include "host/device/usb_polling.hpp"

#include <fmt/format.h>

#include "hal/usb_identity.hpp"
#include "host/atomic_file.hpp"
#include "host/exit_codes.hpp"

namespace host {

std::string usb_polling_options() {
  constexpr unsigned kAlwaysPoll = 1u << 10;
  return fmt::format("options usbhid quirks=0x{:04x}:0x{:04x}:0x{:04x}\n", hal::kUsbVendor, hal::kUsbProduct,
                     kAlwaysPoll);
}

void install_usb_polling() {
  try {
    write_file_atomically(kUsbPollingFile,
                          "# Axis boards open at once, instead of after 50 ms.\n" + usb_polling_options());
  } catch (const std::exception& error) {
    throw Failure(ExitCode::permission,
                  fmt::format("{}; as root: sudo axistool udev-rule --poll-always --install", error.what()));
  }
}

}  // namespace host
