// Independent watchdog: runs on its own oscillator, and nothing but a reset stops it. RM0090, section 21.3.
#pragma once

#include <algorithm>

#include "hal/stm32f4/registers.hpp"

namespace hal::stm32f4 {

class Watchdog {
 public:
  explicit Watchdog(IndependentWatchdog& registers) : registers_(registers) {}

  /// 1..32760 ms nominally; the oscillator has 17 to 47 kHz instead of 32 (datasheet, table 35).
  void start(std::uint32_t timeout_ms) {
    registers_.KR = IndependentWatchdog::kStart;
    allow(timeout_ms);
  }

  /// Another time-out from now on, also while it runs: for work that is known to stall the processor.
  void allow(std::uint32_t timeout_ms) {
    constexpr std::uint32_t kBy16 = 2, kBy256 = 6, kMostTicks = 0xFFF;
    const bool is_long = timeout_ms * 2 > kMostTicks;  // 32 kHz / 16 are 2 ticks a millisecond, / 256 an eighth
    registers_.KR = IndependentWatchdog::kUnlock;
    registers_.PR = is_long ? kBy256 : kBy16;
    registers_.RLR = std::min(is_long ? timeout_ms / 8 : timeout_ms * 2, kMostTicks);
    // A new value counts once it has crossed into the oscillator's domain: within five of its cycles (21.4.4), 0.3 ms.
    for (std::uint32_t poll = 0; poll < 100'000 && registers_.SR != 0; ++poll) continue;
    feed();
  }

  void feed() { registers_.KR = IndependentWatchdog::kFeed; }

 private:
  IndependentWatchdog& registers_;
};

}  // namespace hal::stm32f4
