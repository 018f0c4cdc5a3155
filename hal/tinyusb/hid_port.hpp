// USB HID by TinyUSB: the same code for the chip's controller, USB/IP, and a test's controller.
#pragma once

#include <string_view>

#include "hal/usb_hid.hpp"

namespace hal::tinyusb {

/// A program has one stack with one device, so every HidPort is the same port. All functions are called from the
/// background; the controller's interrupt only queues events.
class HidPort {
 public:
  /// Connects to the bus, with this serial number. False when the controller does not answer.
  bool start(std::string_view serial_number);

  /// Tells whether a computer's supply is on the cable; may be called at any time. Without it the board pulls no data
  /// line up, and is not configured. Assumed present before the first call.
  void attach(bool is_present);

  /// Handles the controller's events since the last call: answers requests of the control pipe, moves reports.
  void poll();

  /// Only for the controller's interrupt.
  void handle_interrupt();

  bool send(const HidReport& report);
  bool receive(HidReport& report);

  /// Also false while the bus is suspended: to a board with its own supply, an unplugged cable looks the same.
  bool is_configured() const;
};
static_assert(UsbHid<HidPort>);

}  // namespace hal::tinyusb
