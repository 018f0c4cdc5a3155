// A serial port: bytes out, bytes in.
#pragma once

#include <concepts>
#include <cstddef>

namespace hal {

/// Contract of the hardware's side: `offer(byte)` gives the byte to the transmitter, or says that it has no room yet;
/// `receive(byte)` takes a byte that has arrived, or says that there is none. Neither waits. Bytes that arrive while an
/// earlier one waits are lost.
template <typename T>
concept SerialLine = requires(T& line, std::byte out, std::byte& in) {
  { line.offer(out) } -> std::same_as<bool>;
  { line.receive(in) } -> std::same_as<bool>;
};

/// Contract of the program's side: as SerialLine, but `send` takes the byte for good.
template <typename T>
concept SerialPort = requires(T& port, std::byte out, std::byte& in) {
  { port.send(out) } -> std::same_as<void>;
  { port.receive(in) } -> std::same_as<bool>;
};

}  // namespace hal
