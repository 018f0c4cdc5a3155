// A serial port: bytes out, bytes in.
#pragma once

#include <concepts>
#include <cstddef>

namespace hal {

/// Contract: `send(byte)` waits until the transmitter takes the byte, for a bounded time (one character at the slowest
/// rate). `receive(byte)` takes a byte that has arrived and returns at once; false if there is none. Bytes that arrive
/// while an earlier one waits are lost.
template <typename T>
concept SerialPort = requires(T& port, std::byte out, std::byte& in) {
  { port.send(out) } -> std::same_as<void>;
  { port.receive(in) } -> std::same_as<bool>;
};

}  // namespace hal
