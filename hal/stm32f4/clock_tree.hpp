// From the 8 MHz crystal to 168 MHz. RM0090, sections 7.2, 7.3 and 3.5.1.
#pragma once

#include "hal/stm32f4/registers.hpp"

namespace hal::stm32f4 {

inline constexpr std::uint32_t kResetClock_Hz = 16'000'000;
inline constexpr std::uint32_t kSystemClock_Hz = 168'000'000;
inline constexpr std::uint32_t kApb1Clock_Hz = 42'000'000;       // window watchdog
inline constexpr std::uint32_t kApb2Clock_Hz = 84'000'000;       // USART1, SPI1, ADC1
inline constexpr std::uint32_t kApb1TimerClock_Hz = 84'000'000;  // TIM2 to TIM5: twice APB1's 42 MHz (7.2)

namespace clock_setup {

/// A crystal starts within 2 ms (datasheet, table 33), 32,000 instructions at 16 MHz; these polls take ten times as
/// long.
inline constexpr int kMostPolls = 400'000;

inline bool wait_for(Register& flags, std::uint32_t mask, std::uint32_t wanted) {
  for (int poll = 0; poll < kMostPolls; ++poll)
    if ((flags & mask) == wanted) return true;
  return false;
}

}  // namespace clock_setup

/// Resets every peripheral and clock, whatever ran before: the ROM's loader leaves the PLL on, and its registers cannot
/// be written then (7.3.2). False when a clock does not respond.
inline bool reset_clocks(Rcc& rcc) {
  using clock_setup::wait_for;
  const auto pulse = [](Register& resets, std::uint32_t which) {
    resets = which;
    resets = 0;
  };
  pulse(rcc.AHB1RSTR, Rcc::kAhb1Resets);
  pulse(rcc.AHB2RSTR, Rcc::kAhb2Resets);
  pulse(rcc.APB1RSTR, Rcc::kApb1Resets);
  pulse(rcc.APB2RSTR, Rcc::kApb2Resets);
  rcc.CR = rcc.CR | Rcc::kHsiOn;
  if (!wait_for(rcc.CR, Rcc::kHsiReady, Rcc::kHsiReady)) return false;
  rcc.CFGR = 0;  // the RC oscillator drives the system, undivided
  if (!wait_for(rcc.CFGR, Rcc::kSwitchedMask, 0)) return false;
  rcc.CR = (rcc.CR & Rcc::kHsiTrim) | Rcc::kHsiOn;
  return wait_for(rcc.CR, Rcc::kPllReady | Rcc::kHseReady, 0);
}

/// False when the crystal or the PLL does not start: the chip then stays on its 16 MHz RC oscillator.
inline bool start_clocks(Rcc& rcc, Power& power, FlashInterface& flash) {
  using clock_setup::wait_for;
  rcc.APB1ENR = rcc.APB1ENR | Rcc::kPower;
  power.CR = power.CR | Power::kScale1;
  rcc.CR = rcc.CR | Rcc::kHseOn;
  if (!wait_for(rcc.CR, Rcc::kHseReady, Rcc::kHseReady)) return false;
  // VCO input 8 MHz / 8, VCO 336 MHz, system 336 / 2, USB 336 / 7 = 48 MHz (7.3.2).
  constexpr std::uint32_t kM = 8, kN = 336, kHalf = 0, kQ = 7;
  rcc.PLLCFGR = kM | kN << 6 | kHalf << 16 | Rcc::kPllFromHse | kQ << 24;
  rcc.CR = rcc.CR | Rcc::kPllOn;
  if (!wait_for(rcc.CR, Rcc::kPllReady, Rcc::kPllReady)) return false;
  flash.ACR = FlashInterface::kFiveWaitStates | FlashInterface::kPrefetch | FlashInterface::kInstructionCache |
              FlashInterface::kDataCache;
  rcc.CFGR = Rcc::kApb1By4 | Rcc::kApb2By2;
  rcc.CFGR = rcc.CFGR | Rcc::kSwitchToPll;
  if (!wait_for(rcc.CFGR, Rcc::kSwitchedMask, Rcc::kSwitchedToPll)) return false;
  rcc.CR = rcc.CR | Rcc::kClockSecurity;  // if the crystal stops later, this raises the non-maskable interrupt
  return true;
}

}  // namespace hal::stm32f4
