// The timer that begins each control period: it triggers the converter's scan and latches the encoders. RM0090, 18.3.1,
// 18.3.8, 18.4.2 and 18.4.4.
#pragma once

#include "hal/stm32f4/registers.hpp"

namespace hal::stm32f4 {

/// The scan of both tachometers begins with the period (TachometerScan). In its middle, compare channels 1 and 2
/// request the transfers of the encoders' counters (EncoderTimer). So position and velocity belong to the same instant.
class ControlTimer {
 public:
  explicit constexpr ControlTimer(Timer& timer) : timer_(timer) {}

  /// The first period begins now.
  void start(std::uint32_t timer_clock_Hz, std::uint32_t rate_Hz) {
    ticks_Hz_ = timer_clock_Hz / kPrescaler;
    timer_.PSC = kPrescaler - 1;
    timer_.CCR1 = latch_ticks();
    timer_.CCR2 = latch_ticks();
    timer_.DIER = Timer::kCompare1Request | Timer::kCompare2Request;
    set_rate(rate_Hz);
    timer_.CR1 = Timer::kEnable;
  }

  /// 250 Hz to 20 kHz; takes effect at once, also while it runs. A count beyond the new end would run on to 65535, so
  /// the counter is reset; the reset alone does not trigger.
  void set_rate(std::uint32_t rate_Hz) {
    timer_.CR2 = 0;
    timer_.ARR = ticks_Hz_ / rate_Hz - 1;
    timer_.EGR = Timer::kUpdate;
    timer_.CR2 = Timer::kTriggerOnUpdate;
  }

 private:
  static constexpr std::uint32_t kLatch_us = 13;  // half of the scan's 26 us
  static constexpr std::uint32_t kPrescaler = 8;  // 10.5 MHz: 250 Hz still fit 16 bits

  std::uint32_t latch_ticks() const { return ticks_Hz_ / 1000 * kLatch_us / 1000; }

  Timer& timer_;
  std::uint32_t ticks_Hz_ = 10'500'000;
};

}  // namespace hal::stm32f4
