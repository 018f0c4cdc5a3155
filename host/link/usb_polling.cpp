#include "host/link/usb_polling.hpp"

#include <fmt/format.h>

#include <fstream>

#include "hal/usb_identity.hpp"
#include "host/atomic_file.hpp"
#include "host/exit_codes.hpp"

namespace host {

namespace {

/// Vendor, product and HID_QUIRK_ALWAYS_POLL, in the format of usbhid's option.
std::string quirk() {
  constexpr unsigned kAlwaysPoll = 1u << 10;
  return fmt::format("0x{:04x}:0x{:04x}:0x{:04x}", hal::kUsbVendor, hal::kUsbProduct, kAlwaysPoll);
}

}  // namespace

std::string usb_polling_options() { return fmt::format("options usbhid quirks={}\n", quirk()); }

bool usb_polls_always() {
  std::ifstream in("/sys/module/usbhid/parameters/quirks");
  std::string given;
  return std::getline(in, given) && given.find(quirk()) != std::string::npos;
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
