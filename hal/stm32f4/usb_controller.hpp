// The full-speed USB controller before TinyUSB takes it over, and the chip's unique identifier. RM0090, chapters
// 34, 39.
#pragma once

#include <array>

#include "hal/stm32f4/pin.hpp"
#include "hal/usb_identity.hpp"

namespace hal::stm32f4 {

/// A computer's supply, behind a divider. The controller's own input for it, PA9, is the service port's.
class VbusInput {
 public:
  explicit constexpr VbusInput(Pin pin) : pin_(pin) {}
  void start() { pin_.make_input(Pull::down); }
  /// Beside a servo amplifier single readings lie: it changes once it has read otherwise for `steady` of the units of
  /// `now`, without a break.
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

/// Clock on. The controller takes VBUS for present at all times; whether it pulls D+ up is then decided by who asks
/// VbusInput: a device must not feed the bus of a host that is off (USB 2.0, 7.1.5).
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
