// The two devices of Arm's MPS2 boards that QEMU's mps2-an386 emulates and this project uses: a UART and a watchdog
// that really resets. Sections are those of the Cortex-M System Design Kit's manual (DDI 0479).
#pragma once

#include "hal/cortex_m/registers.hpp"
#include "hal/serial_port.hpp"

namespace hal::mps2 {

using cortex_m::at_address;
using cortex_m::Register;

/// APB UART, section 4.3.
class UartPort {
 public:
  void start() {
    registers().BAUDDIV = 16;  // the smallest allowed value; the emulator sends at once
    registers().CTRL = kTransmit | kReceive;
  }

  bool offer(std::byte byte) {
    if ((registers().STATE & kTransmitFull) != 0) return false;
    registers().DATA = static_cast<std::uint32_t>(byte);
    return true;
  }

  bool receive(std::byte& byte) {
    if ((registers().STATE & kReceiveFull) == 0) return false;
    byte = static_cast<std::byte>(registers().DATA & 0xFF);
    return true;
  }

 private:
  struct Registers {
    Register DATA, STATE, CTRL, INTSTATUS, BAUDDIV;
  };
  static Registers& registers() { return at_address<Registers>(0x40004000); }
  static constexpr std::uint32_t kTransmitFull = 1u << 0, kReceiveFull = 1u << 1;  // STATE
  static constexpr std::uint32_t kTransmit = 1u << 0, kReceive = 1u << 1;          // CTRL
};
static_assert(SerialLine<UartPort>);

/// APB watchdog, section 4.6: its first time-out requests an interrupt, its second resets.
class Watchdog {
 public:
  /// Resets after twice `ticks` of the 25 MHz clock without feeding.
  void start(std::uint32_t ticks) {
    registers().LOCK = kUnlock;
    registers().LOAD = ticks;
    registers().CTRL = kInterrupt | kReset;
  }

  void feed() { registers().INTCLR = 1; }

 private:
  struct Registers {
    Register LOAD, VALUE, CTRL, INTCLR, RIS, MIS;
    std::uint32_t reserved[762];
    Register LOCK;
  };
  static Registers& registers() { return at_address<Registers>(0x40008000); }
  static constexpr std::uint32_t kInterrupt = 1u << 0, kReset = 1u << 1;
  static constexpr std::uint32_t kUnlock = 0x1ACCE551;
};

}  // namespace hal::mps2
