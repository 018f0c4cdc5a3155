// SPI master that sends 24-bit words with a chip select of its own. RM0090, section 28.3.3.
#pragma once

#include "hal/stm32f4/pin.hpp"

namespace hal::stm32f4 {

class SpiPort {
 public:
  SpiPort(Spi& registers, Pin select) : registers_(registers), select_(select) {}

  /// Mode 1 (clock idles low, data are taken at its falling edge), 84 MHz / 4 = 21 MHz.
  void start() {
    select_.make_output(true);
    registers_.CR1 = Spi::kMaster | Spi::kSoftwareSelect | Spi::kBaudBy4 | Spi::kClockPhase2 | Spi::kEnable;
  }

  /// Most significant bit first. False when the peripheral does not answer: no clock, or not started.
  bool send24(std::uint32_t word) {
    select_.set(false);
    bool sent = true;
    for (int shift = 16; shift >= 0 && sent; shift -= 8) {
      registers_.DR = word >> shift & 0xFF;
      sent = wait_for(Spi::kReceived, Spi::kReceived);
      static_cast<void>(static_cast<std::uint32_t>(registers_.DR));
    }
    sent = sent && wait_for(Spi::kBusy, 0);
    select_.set(true);
    return sent;
  }

 private:
  /// A byte takes 64 processor clocks; polls beyond that mean a dead peripheral.
  bool wait_for(std::uint32_t mask, std::uint32_t wanted) {
    constexpr int kMostPolls = 100;
    for (int poll = 0; poll < kMostPolls; ++poll)
      if ((registers_.SR & mask) == wanted) return true;
    return false;
  }

  Spi& registers_;
  Pin select_;
};

}  // namespace hal::stm32f4
