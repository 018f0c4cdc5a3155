// Microseconds from a 16-bit timer, extended to 32 bits at each call.
#pragma once

#include "hal/clock.hpp"
#include "hal/stm32f4/registers.hpp"

namespace hal::stm32f4 {

/// Correct while now_us() is called at least every 65 ms; one caller only.
class MicrosecondClock {
 public:
  explicit MicrosecondClock(Timer& timer) : timer_(timer) {}

  void start(std::uint32_t timer_clock_Hz) {
    timer_.PSC = timer_clock_Hz / 1'000'000 - 1;
    timer_.ARR = 0xFFFF;
    timer_.EGR = Timer::kUpdate;
    timer_.CR1 = Timer::kEnable;
  }

  std::uint32_t now_us() {
    now_us_ += (timer_.CNT - now_us_) & 0xFFFF;
    return now_us_;
  }

 private:
  Timer& timer_;
  std::uint32_t now_us_ = 0;
};
static_assert(Clock<MicrosecondClock>);

}  // namespace hal::stm32f4
