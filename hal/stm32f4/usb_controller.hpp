// The full-speed USB controller before TinyUSB takes it over, and the chip's unique identifier. RM0090, chapters
// 34, 39.
#pragma once

#include <array>

#include "hal/stm32f4/pin.hpp"
#include "hal/usb_identity.hpp"

namespace hal::stm32f4 {

/// A computer's supply, behind a divider. The service port uses PA9, the controller's own input for it.
class VbusInput {
 public:
  explicit constexpr VbusInput(Pin pin) : pin_(pin) {}
  void start() { pin_.make_input(Pull::down); }
  /// Filters noise of servo amplifiers: the state changes once the input has differed from it for `steady` units of
  /// `now` without interruption.
  bool is_present(std::uint32_t now, std::uint32_t steady) {
    const bool reads = pin_.read();
    if (reads == is_present_)
      agreed_at_ = now;
    else if (now - agreed_at_ >= steady)
      is_present_ = reads;
    return is_present_;
  }

 private:
  Pin pin_;
  bool is_present_ = false;
  std::uint32_t agreed_at_ = 0;
};

/// Switches the clock on. The controller always assumes that VBUS is present; the user of VbusInput decides whether it
/// pulls D+ up, because a device must not supply the bus of a host that is off (USB 2.0, 7.1.5).
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
