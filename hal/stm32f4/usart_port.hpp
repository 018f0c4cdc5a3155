// Serial line on a USART.
#pragma once

#include "hal/serial_port.hpp"
#include "hal/stm32f4/registers.hpp"

namespace hal::stm32f4 {

class UsartPort {
 public:
  explicit constexpr UsartPort(Usart& registers) : registers_(registers) {}

  /// 8 data bits, no parity, one stop bit. RM0090, 30.3.4: with 16-fold oversampling BRR is clock / baud.
  void start(std::uint32_t clock_Hz, std::uint32_t baud) {
    registers_.BRR = (clock_Hz + baud / 2) / baud;
    registers_.CR1 = Usart::kEnable | Usart::kTransmitter | Usart::kReceiver;
  }

  bool offer(std::byte byte) {
    if ((registers_.SR & Usart::kTransmitEmpty) == 0) return false;
    registers_.DR = static_cast<std::uint32_t>(byte);
    return true;
  }

  /// Reading SR and then DR also clears an overrun (30.6.1).
  bool receive(std::byte& byte) {
    if ((registers_.SR & Usart::kReceived) == 0) return false;
    byte = static_cast<std::byte>(registers_.DR & 0xFF);
    return true;
  }

 private:
  Usart& registers_;
};

static_assert(SerialLine<UsartPort>);

}  // namespace hal::stm32f4
