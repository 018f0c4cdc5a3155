// Text and numbers to a serial port, without the C library.
#pragma once

#include <array>
#include <cstdint>

#include "hal/serial_port.hpp"

namespace firmware::boards {

template <hal::SerialPort Port>
class TextWriter {
 public:
  explicit TextWriter(Port& port) : port_(port) {}

  TextWriter& operator<<(const char* text) {
    for (; *text != '\0'; ++text) port_.send(static_cast<std::byte>(*text));
    return *this;
  }

  TextWriter& operator<<(std::uint32_t value) {
    std::array<char, 11> digits{};
    std::size_t first = digits.size() - 1;
    do {
      digits[--first] = static_cast<char>('0' + value % 10);
      value /= 10;
    } while (value != 0);
    return *this << &digits[first];
  }

  TextWriter& operator<<(std::int32_t value) {
    if (value < 0) return *this << "-" << (0u - static_cast<std::uint32_t>(value));
    return *this << static_cast<std::uint32_t>(value);
  }

  TextWriter& hex(std::uint32_t value) {
    *this << "0x";
    for (int shift = 28; shift >= 0; shift -= 4) {
      const char digit[2] = {"0123456789abcdef"[(value >> shift) & 0xF], '\0'};
      *this << digit;
    }
    return *this;
  }

 private:
  Port& port_;
};

}  // namespace firmware::boards
