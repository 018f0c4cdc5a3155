// Independent watchdog: runs on its own oscillator, and nothing but a reset stops it. RM0090, section 21.3.
#pragma once

#include <algorithm>

#include "hal/stm32f4/registers.hpp"

namespace hal::stm32f4 {

class Watchdog {
 public:
  explicit Watchdog(IndependentWatchdog& registers) : registers_(registers) {}

  /// 1..2047 ms nominally; the oscillator has 17 to 47 kHz instead of 32 (datasheet, table 35).
  void start(std::uint32_t timeout_ms) {
    constexpr std::uint32_t kBy16 = 2, kTicksPerMs = 2, kMostTicks = 0xFFF;
    registers_.KR = IndependentWatchdog::kStart;
    registers_.KR = IndependentWatchdog::kUnlock;
    registers_.PR = kBy16;
    registers_.RLR = std::min(timeout_ms * kTicksPerMs, kMostTicks);
    feed();
  }

  void feed() { registers_.KR = IndependentWatchdog::kFeed; }

 private:
  IndependentWatchdog& registers_;
};

}  // namespace hal::stm32f4
