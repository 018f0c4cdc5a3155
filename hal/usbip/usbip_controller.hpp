// A USB controller for TinyUSB whose bus is a socket: it speaks USB/IP, and Linux' vhci-hcd at the socket's other end
// makes the board a real USB device of the computer.
#pragma once

#include <chrono>

#include "hal/tinyusb/hid_port.hpp"

namespace hal::usbip {

/// One device per program, because TinyUSB has one stack per program.
class UsbipController {
 public:
  /// Takes over the socket and signals to `port`, which must have been started, the bus reset of a new host. An
  /// endpoint moves one report per `frame`, as on a real bus; vhci-hcd alone would transfer as fast as the computer
  /// can.
  UsbipController(int socket, tinyusb::HidPort& port, std::chrono::microseconds frame = std::chrono::milliseconds(1));
  UsbipController(const UsbipController&) = delete;
  UsbipController& operator=(const UsbipController&) = delete;
  ~UsbipController();

  /// Waits for transfers for at most the given time, and handles them. False if the host is gone or does not speak
  /// USB/IP; then the port is no longer configured.
  bool serve(std::chrono::nanoseconds wait);

 private:
  tinyusb::HidPort& port_;
};

}  // namespace hal::usbip
