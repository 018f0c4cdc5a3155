// Quadrature encoder on a 32-bit timer (TIM2 or TIM5). RM0090, section 18.3.12.
#pragma once

#include "hal/encoder.hpp"
#include "hal/stm32f4/registers.hpp"

namespace hal::stm32f4 {

/// Channels 1 and 2 count every edge of A and B, channel 3 captures the counter at the index pulse, channel 4 at the
/// trigger of the probe's timer (ProbeTimer). The hardware counts all 32 bits, so no overflow needs an interrupt.
class EncoderTimer {
 public:
  /// `probe_trigger`: the input, ITR0 to ITR3, at which the probe's timer reaches this one (18.4.3).
  EncoderTimer(Timer& registers, std::uint32_t probe_trigger) : registers_(registers), probe_trigger_(probe_trigger) {}

  void start() {
    registers_.CCMR1 = Timer::kFilteredPin | Timer::kFilteredPin << 8;
    registers_.CCMR2 = Timer::kFilteredPin | Timer::kInternalTrigger << 8;
    registers_.CCER = Timer::kCapture3Enable | Timer::kCapture4Enable;
    registers_.SMCR = Timer::from_trigger(probe_trigger_) | Timer::kEncoderBothEdges;
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

  EncoderReading read_latch() {
    const bool came = (registers_.SR & Timer::kCapture4Flag) != 0;
    return {.counts = registers_.CCR4, .valid = came};  // reading it clears the flag
  }

 private:
  Timer& registers_;
  std::uint32_t probe_trigger_;
};
static_assert(IndexedEncoder<EncoderTimer> && LatchedEncoder<EncoderTimer>);

}  // namespace hal::stm32f4
