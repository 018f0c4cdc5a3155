// Quadrature encoder on a 32-bit timer (TIM2 or TIM5). RM0090, section 18.3.12.
#pragma once

#include "hal/encoder.hpp"
#include "hal/stm32f4/registers.hpp"

namespace hal::stm32f4 {

/// Channels 1 and 2 count every edge of A and B, channel 3 captures the counter at the index pulse. The hardware counts
/// all 32 bits, so no overflow needs an interrupt.
class EncoderTimer {
 public:
  explicit EncoderTimer(Timer& registers) : registers_(registers) {}

  void start() {
    constexpr std::uint32_t kInput = 1, kFilter = 3;  // CCxS: own pin; ICxF: 8 equal samples at 84 MHz (18.4.7)
    constexpr std::uint32_t kChannel = kInput | kFilter << 4;
    registers_.CCMR1 = kChannel | kChannel << 8;
    registers_.CCMR2 = kChannel;
    registers_.CCER = Timer::kCapture3Enable;
    registers_.SMCR = Timer::kEncoderBothEdges;
    registers_.ARR = 0xFFFFFFFFu;
    registers_.CNT = 0;
    registers_.CR1 = Timer::kEnable;
  }

  EncoderReading read() { return {.counts = registers_.CNT, .valid = true}; }

  IndexReading read_index() {
    const std::uint32_t status = registers_.SR;
    if ((status & Timer::kCapture3Flag) == 0) return {};
    const std::uint32_t counts = registers_.CCR3;  // reading it clears the flag (18.4.5)
    const bool missed = (status & Timer::kOvercapture3Flag) != 0;
    if (missed) registers_.SR = ~Timer::kOvercapture3Flag;
    return {.counts = counts, .seen = true, .missed = missed};
  }

 private:
  Timer& registers_;
};
static_assert(IndexedEncoder<EncoderTimer>);

}  // namespace hal::stm32f4
