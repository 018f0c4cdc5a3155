// A serial port: bytes out, bytes in.
#pragma once

#include <concepts>
#include <cstddef>

namespace hal {

/// Contract of the hardware's side: `offer(byte)` gives the byte to the transmitter, or returns false if it has no room
/// yet; `receive(byte)` takes a received byte, or returns false if there is none. Neither waits. Bytes that arrive
/// while an earlier one is unread are lost.
template <typename T>
concept SerialLine = requires(T& line, std::byte out, std::byte& in) {
  { line.offer(out) } -> std::same_as<bool>;
  { line.receive(in) } -> std::same_as<bool>;
};

/// Contract of the program's side: like SerialLine, but `send` always accepts the byte.
template <typename T>
concept SerialPort = requires(T& port, std::byte out, std::byte& in) {
  { port.send(out) } -> std::same_as<void>;
  { port.receive(in) } -> std::same_as<bool>;
};

}  // namespace hal
