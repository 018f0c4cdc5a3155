// The parts of the axis board that the boot code needs: flash and watchdog. Clocks and pins keep their state after
// reset.
#pragma once

#include "hal/stm32f4/chip_flash.hpp"
#include "hal/stm32f4/watchdog.hpp"

namespace firmware::boards {

class BootBoard {
 public:
  static constexpr std::uintptr_t kProgram = hal::stm32f4::ImageFlash::kFirstAddress;

  hal::stm32f4::ImageFlash& image_flash() { return flash_; }

  /// The watchdog resets a program that hangs before it configures the watchdog itself.
  void watch_trial() {
    constexpr std::uint32_t kTrial_ms = 30'000;  // 20 to 56 s, due to its oscillator; every start takes less than 5 s
    hal::stm32f4::Watchdog(hal::stm32f4::independent_watchdog()).start(kTrial_ms);
  }

 private:
  hal::stm32f4::ImageFlash flash_{hal::stm32f4::flash_interface(), reinterpret_cast<std::byte*>(kProgram)};
};

}  // namespace firmware::boards
