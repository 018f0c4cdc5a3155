// A USB controller for TinyUSB whose bus is a socket: it speaks USB/IP, and Linux' vhci-hcd at the socket's other end
// makes the board a real USB device of the computer.
#pragma once

#include <chrono>

#include "hal/tinyusb/hid_port.hpp"

namespace hal::usbip {

/// One device a program, because TinyUSB's stack is the program's.
class UsbipController {
 public:
  /// Takes over the socket and shows `port`, which must have been started, the bus reset that a new host begins with.
  /// An endpoint moves one report a `frame`, as on a real bus; vhci-hcd alone would go as fast as the computer can.
  UsbipController(int socket, tinyusb::HidPort& port, std::chrono::microseconds frame = std::chrono::milliseconds(1));
  UsbipController(const UsbipController&) = delete;
  UsbipController& operator=(const UsbipController&) = delete;
  ~UsbipController();

  /// Waits for transfers at most as long as said, and handles those that are there. False when the host has gone, or
  /// does not speak USB/IP; the port is then not configured any more.
  bool serve(std::chrono::nanoseconds wait);

 private:
  tinyusb::HidPort& port_;
};

}  // namespace hal::usbip
