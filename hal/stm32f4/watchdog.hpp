// The two watchdogs; only a reset stops them.
#pragma once

#include <algorithm>

#include "hal/stm32f4/registers.hpp"

namespace hal::stm32f4 {

/// Runs on an oscillator of its own, so it detects a stopped program and a stopped clock. RM0090, section 21.3.
class Watchdog {
 public:
  explicit constexpr Watchdog(IndependentWatchdog& registers) : registers_(registers) {}

  /// 1..32760 ms nominally; the oscillator has 17 to 47 kHz instead of 32 kHz (datasheet, table 35).
  void start(std::uint32_t timeout_ms) {
    registers_.KR = IndependentWatchdog::kStart;
    allow(timeout_ms);
  }

  /// Changes the time-out, also while it runs: for work that stalls the processor.
  void allow(std::uint32_t timeout_ms) {
    constexpr std::uint32_t kBy16 = 2, kBy256 = 6, kMostTicks = 0xFFF;
    const bool is_long = timeout_ms * 2 > kMostTicks;  // 32 kHz / 16: 2 ticks per ms; 32 kHz / 256: 1/8 tick per ms
    registers_.KR = IndependentWatchdog::kUnlock;
    registers_.PR = is_long ? kBy256 : kBy16;
    registers_.RLR = std::min(is_long ? timeout_ms / 8 : timeout_ms * 2, kMostTicks);
    // A new value takes effect once it has reached the oscillator's clock domain: within five of its cycles (21.4.4),
    // 0.3 ms.
    for (std::uint32_t poll = 0; poll < 50'000 && registers_.SR != 0; ++poll) continue;
    feed();
  }

  void feed() { registers_.KR = IndependentWatchdog::kFeed; }

 private:
  IndependentWatchdog& registers_;
};

/// Runs on the bus clock and must be fed neither too late nor too early: detects a wrong rate of the control interrupt.
/// RM0090, chapter 22.
class PeriodWatchdog {
 public:
  explicit constexpr PeriodWatchdog(WindowWatchdog& registers) : registers_(registers) {}

  /// period_passed() feeds it every 16 to 20 ms, if called every 50 us to 4 ms. A tick is 4096 * 8 clocks, 0.78 ms:
  /// feeding before 9.4 ms is too early, after 30 ms too late. Do not call start() while period_passed() may be called.
  void start() {
    registers_.CFR = WindowWatchdog::kBy8 | kEarliest;
    registers_.CR = WindowWatchdog::kRun | kFrom;
    passed_us_ = 0;
    runs_ = true;
  }

  /// Call it once per period, with the period's length.
  void period_passed(std::uint32_t period_us) {
    passed_us_ += period_us;
    if (!runs_ || passed_us_ < kFed_us) return;
    passed_us_ = 0;
    registers_.CR = WindowWatchdog::kRun | kFrom;
  }

 private:
  static constexpr std::uint32_t kFed_us = 16'000;
  static constexpr std::uint32_t kFrom = WindowWatchdog::kLeast + 38;      // 39 ticks: 30.4 ms
  static constexpr std::uint32_t kEarliest = WindowWatchdog::kLeast + 26;  // 12 ticks after that: 9.4 ms

  WindowWatchdog& registers_;
  std::uint32_t passed_us_ = 0;
  bool runs_ = false;
};

}  // namespace hal::stm32f4
