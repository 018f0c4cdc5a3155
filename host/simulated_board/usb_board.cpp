#include "host/simulated_board/usb_board.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <system_error>

#include "hal/usbip/usbip_controller.hpp"
#include "hal/usbip/vhci_port.hpp"
#include "host/exit_codes.hpp"

namespace host {

namespace {

using std::chrono::microseconds;
using std::chrono::nanoseconds;
using std::chrono::steady_clock;

std::unique_ptr<hal::usbip::UsbipController> plug_in(hal::tinyusb::HidPort& port) {
  try {
    return std::make_unique<hal::usbip::UsbipController>(hal::usbip::plug_into_vhci(), port);
  } catch (const std::system_error& error) {
    const bool denied = error.code() == std::errc::permission_denied;
    throw Failure(denied ? ExitCode::permission : ExitCode::no_such_device,
                  fmt::format("{}{}", error.what(), denied ? ": connecting a USB device needs root: use sudo" : ""));
  }
}

}  // namespace

void serve_simulated_device_on_usb(SimulatedDevice& device, const std::string& serial_number,
                                   const std::atomic<bool>& stop) {
  constexpr auto kMostLag = std::chrono::milliseconds(20);  // a longer lag would look like a silent host
  hal::tinyusb::HidPort port;
  if (!port.start(serial_number)) throw Failure(ExitCode::no_such_device, "the USB stack does not start");
  auto controller = plug_in(port);
  auto next = steady_clock::now();
  while (!stop) {
    next += microseconds(device.run_control_period());
    device.poll(port);
    if (device.wants_restart()) {
      controller.reset();
      device.power_up();
      controller = plug_in(port);
    }
    next = std::max(next, steady_clock::now() - kMostLag);
    do {
      if (!controller->serve(std::max(nanoseconds(next - steady_clock::now()), nanoseconds(0)))) return;
      device.poll(port);
    } while (steady_clock::now() < next && !stop);
  }
}

}  // namespace host
