// USB HID device endpoint pair: 64-byte reports each way.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>

namespace hal {

/// One full-speed interrupt packet (USB 2.0, section 5.7.3: at most 64 bytes).
inline constexpr std::size_t kHidReportSize = 64;
using HidReport = std::array<std::byte, kHidReportSize>;

/// Contract: both calls return at once. `send` queues one report and returns false when the queue is full or the host
/// has not configured the device; the report is then not taken. `receive` takes the oldest report that the host sent
/// and returns false when there is none; reports are never dropped, the endpoint refuses them while the queue is full.
/// `is_configured()` is false from a bus reset or detach until the host has configured the device again.
template <typename T>
concept UsbHid = requires(T& usb, const HidReport& out, HidReport& in) {
  { usb.send(out) } -> std::same_as<bool>;
  { usb.receive(in) } -> std::same_as<bool>;
  { usb.is_configured() } -> std::same_as<bool>;
};

}  // namespace hal
