// USB HID by TinyUSB: the same code over the chip's controller, over USB/IP, and over a test's controller.
#pragma once

#include <string_view>

#include "hal/usb_hid.hpp"

namespace hal::tinyusb {

/// The stack and its one device are the program's: every HidPort is the same port. Everything is called from one place,
/// the background; the controller's interrupt only queues events.
class HidPort {
 public:
  /// Connects to the bus, with this serial number. False when the controller does not answer.
  bool start(std::string_view serial_number);

  /// Whether a computer's supply is on the cable, as often as one likes. Without it the board pulls no data line up,
  /// and is not configured. Taken for present until told otherwise.
  void attach(bool is_present);

  /// Handles what the controller has reported since. Calls back, answers requests of the control pipe, moves reports.
  void poll();

  /// For the controller's interrupt alone.
  void handle_interrupt();

  bool send(const HidReport& report);
  bool receive(HidReport& report);

  /// Also false while the bus is suspended: a board with its own supply sees a pulled cable as that.
  bool is_configured() const;
};
static_assert(UsbHid<HidPort>);

}  // namespace hal::tinyusb
