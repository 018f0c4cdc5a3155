// One pin of a port. RM0090, section 8.4.
#pragma once

#include "hal/stm32f4/registers.hpp"

namespace hal::stm32f4 {

enum class Pull : std::uint8_t { none = 0, up = 1, down = 2 };

class Pin {
 public:
  constexpr Pin(Gpio& port, std::uint32_t number) : port_(port), number_(number) {}

  /// Push-pull, with `level` from the beginning. Edges take up to 100 ns, `fast` ones 6 ns (datasheet, I/O AC
  /// characteristics).
  void make_output(bool level, bool fast = false) const {
    set(level);
    write_field(port_.OSPEEDR, fast ? 2 : 0);
    write_field(port_.MODER, 1);
  }

  void make_input(Pull pull) const {
    write_field(port_.PUPDR, static_cast<std::uint32_t>(pull));
    write_field(port_.MODER, 0);
  }

  /// `function`: AF0 to AF15 (STM32F405 datasheet, table 9). Fast edges: 50 MHz.
  void make_alternate(std::uint32_t function, Pull pull = Pull::none) const {
    Register& select = port_.AFR[number_ / 8];
    const std::uint32_t shift = number_ % 8 * 4;
    select = (select & ~(0xFu << shift)) | function << shift;
    write_field(port_.PUPDR, static_cast<std::uint32_t>(pull));
    write_field(port_.OSPEEDR, 2);
    write_field(port_.MODER, 2);
  }

  void make_analogue() const { write_field(port_.MODER, 3); }

  void set(bool level) const { port_.BSRR = 1u << (number_ + (level ? 0 : 16)); }
  bool read() const { return (port_.IDR >> number_ & 1u) != 0; }

 private:
  void write_field(Register& target, std::uint32_t value) const {
    const std::uint32_t shift = number_ * 2;
    target = (target & ~(3u << shift)) | value << shift;
  }

  Gpio& port_;
  std::uint32_t number_;
};

}  // namespace hal::stm32f4
