// The full-speed USB controller before TinyUSB takes it over, and the chip's unique identifier. RM0090, chapters
// 34, 39.
#pragma once

#include <array>

#include "hal/stm32f4/registers.hpp"
#include "hal/usb_identity.hpp"

namespace hal::stm32f4 {

/// Clock on, and connected for good: the board has a supply of its own and PA9, where VBUS could be sensed, is the
/// service port's.
inline void power_usb_controller(Rcc& rcc, OtgFsGlobal& controller) {
  rcc.AHB2ENR = rcc.AHB2ENR | Rcc::kOtgFs;
  controller.GCCFG = controller.GCCFG | OtgFsGlobal::kNoVbusSensing;
}

/// The 96 bits in hexadecimal, most significant digit first.
inline std::array<char, kUsbSerialNumberSize> serial_number_text(const UniqueIdentifier& identifier) {
  constexpr char kDigits[] = "0123456789ABCDEF";
  std::array<char, kUsbSerialNumberSize> text{};
  for (std::size_t digit = 0; digit < text.size(); ++digit) {
    const std::size_t place = text.size() - 1 - digit;
    text[digit] = kDigits[identifier.words[place / 8] >> (place % 8 * 4) & 0xF];
  }
  return text;
}

}  // namespace hal::stm32f4
