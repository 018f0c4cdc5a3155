// SPI master that exchanges 24-bit words with a chip select of its own. RM0090, section 28.3.3.
#pragma once

#include "hal/stm32f4/pin.hpp"

namespace hal::stm32f4 {

class SpiPort {
 public:
  constexpr SpiPort(Spi& registers, Pin select) : registers_(registers), select_(select) {}

  /// Mode 1: clock idles low, data are taken at its falling edge.
  void start() {
    select_.make_output(true, true);  // the times of a frame are below 100 ns
    registers_.CR1 = kSending;
    registers_.CR1 = kSending | Spi::kEnable;
  }

  /// Most significant bit first, at 84 MHz / 4 = 21 MHz. False when the peripheral does not answer: no clock, or not
  /// started.
  bool send24(std::uint32_t word) {
    std::uint32_t ignored = 0;
    return transfer(word, ignored);
  }

  /// The same at 84 MHz / 8 = 10.5 MHz, and returns the received word. The other end's answer may take most of half a
  /// clock (48 ns) to reach the line. A slower clock would delay the control interrupt longer.
  bool exchange24(std::uint32_t word, std::uint32_t& reply) {
    registers_.CR1 = kReceiving;  // the rate changes while the port is off (28.3.3)
    registers_.CR1 = kReceiving | Spi::kEnable;
    const bool sent = transfer(word, reply);
    registers_.CR1 = kSending;
    registers_.CR1 = kSending | Spi::kEnable;
    return sent;
  }

  /// Waits at least this long: a read over the peripheral bus takes at least two of its clocks, 24 ns.
  void pause_ns(std::uint32_t time_ns) {
    for (std::uint32_t passed = 0; passed < time_ns; passed += kRead_ns)
      static_cast<void>(static_cast<std::uint32_t>(registers_.SR));
  }

 private:
  static constexpr std::uint32_t kMode = Spi::kMaster | Spi::kSoftwareSelect | Spi::kClockPhase2;
  static constexpr std::uint32_t kSending = kMode | Spi::kBaudBy4, kReceiving = kMode | Spi::kBaudBy8;
  static constexpr std::uint32_t kRead_ns = 23;

  bool transfer(std::uint32_t word, std::uint32_t& reply) {
    select_.set(false);
    bool sent = true;
    reply = 0;
    for (int shift = 16; shift >= 0 && sent; shift -= 8) {
      registers_.DR = word >> shift & 0xFF;
      sent = wait_for(Spi::kReceived, Spi::kReceived);
      reply = reply << 8 | (registers_.DR & 0xFF);
    }
    sent = sent && wait_for(Spi::kBusy, 0);
    select_.set(true);
    return sent;
  }

  /// A byte takes 64 or 128 processor clocks; polls beyond that mean a dead peripheral.
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
