// What the boot code needs of the axis board: its flash and its watchdog. Clocks and pins stay as reset leaves them.
#pragma once

#include "hal/stm32f4/chip_flash.hpp"
#include "hal/stm32f4/watchdog.hpp"

namespace firmware::boards {

class BootBoard {
 public:
  static constexpr std::uintptr_t kProgram = hal::stm32f4::ImageFlash::kFirstAddress;

  hal::stm32f4::ImageFlash& image_flash() { return flash_; }

  /// The watchdog resets a program that hangs before it has set it up itself.
  void watch_trial() {
    constexpr std::uint32_t kTrial_ms = 30'000;  // 20 to 56 s by its oscillator, and no start takes 5
    hal::stm32f4::Watchdog(hal::stm32f4::independent_watchdog()).start(kTrial_ms);
  }

 private:
  hal::stm32f4::ImageFlash flash_{hal::stm32f4::flash_interface(), reinterpret_cast<std::byte*>(kProgram)};
};

}  // namespace firmware::boards
