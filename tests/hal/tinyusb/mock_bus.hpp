// A USB host and the controller between it and TinyUSB, in one thread: each transfer runs to its end, a stall or a NAK.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "hal/tinyusb/hid_port.hpp"

namespace usb_test {

using Bytes = std::vector<std::uint8_t>;

enum class Outcome { done, stalled, not_ready };

struct Transfer {
  Outcome outcome = Outcome::not_ready;
  Bytes data;
};

struct Request {
  std::uint8_t type = 0, code = 0;
  std::uint16_t value = 0, index = 0, length = 0;
};

class MockBus {
 public:
  /// The port must have been started.
  explicit MockBus(hal::tinyusb::HidPort& port) : port_(port) {}

  void reset();
  void suspend();
  void resume();
  void unplug();

  Transfer control(const Request& request, const Bytes& out = {});
  /// One interrupt transaction. not_ready: the device answers NAK.
  Transfer in(std::uint8_t endpoint);
  Outcome out(std::uint8_t endpoint, const Bytes& data);

  /// Enumerates the device as a computer does; true if every step was answered.
  bool enumerate(std::uint8_t address);

  /// Whether the device pulls D+ up.
  static bool sees_device();

  /// The address that the device has been given; 0 after a reset.
  static std::uint8_t address();

 private:
  hal::tinyusb::HidPort& port_;
};

}  // namespace usb_test
