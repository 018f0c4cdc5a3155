// Quadrature encoder on a 32-bit timer (TIM2 or TIM5), latched once a control period by DMA. RM0090, sections 18.3.12
// and 10.3.
#pragma once

#include "hal/encoder.hpp"
#include "hal/stm32f4/pin.hpp"
#include "hal/stm32f4/registers.hpp"

namespace hal::stm32f4 {

/// Channels 1 and 2 count every edge of A and B. Channel 3 captures the counter at the index pulse, channel 4 at the
/// trigger of the probe's timer (ProbeTimer). The hardware counts all 32 bits, so no overflow needs an interrupt.
///
/// A stream of DMA1 copies the counter at a compare event of the control timer. So the control interrupt's delay does
/// not change the position that it reads: the transfer waits at most for other accesses to the bus, 0.2 us.
///
/// The receivers' fault output is high while a wire is broken. An open pin reads high too.
class EncoderTimer {
 public:
  /// `probe_trigger`: the input, ITR0 to ITR3, at which the probe's timer reaches this one (18.4.3). `latch`: the
  /// stream of DMA1 whose channel 5 is a compare event of TIM3: 4 or 5 (table 42).
  EncoderTimer(Timer& registers, std::uint32_t probe_trigger, DmaStream& latch, Pin receivers_fault)
      : registers_(registers), probe_trigger_(probe_trigger), latch_(latch), receivers_fault_(receivers_fault) {}

  void start() {
    receivers_fault_.make_input(Pull::up);
    registers_.CCMR1 = Timer::kFilteredPin | Timer::kFilteredPin << 8;
    registers_.CCMR2 = Timer::kFilteredPin | Timer::kInternalTrigger << 8;
    registers_.CCER = Timer::kCapture3Enable | Timer::kCapture4Enable;
    registers_.SMCR = Timer::from_trigger(probe_trigger_) | Timer::kEncoderBothEdges;
    registers_.ARR = 0xFFFFFFFFu;
    registers_.CNT = 0;
    registers_.CR1 = Timer::kEnable;
    start_latch();
  }

  /// The counter in this control period. A bus error ends the stream (10.3.18).
  EncoderReading read() { return {.counts = latched_, .valid = (latch_.CR & DmaStream::kEnable) != 0}; }

  bool is_faulted() { return receivers_fault_.read(); }

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
  /// Switches the stream off, sets it up, and switches it on (10.3.17). Its flags are as after reset.
  void start_latch() {
    latch_.PAR = static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(&registers_.CNT));
    latch_.M0AR = static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(&latched_));
    latch_.NDTR = 1;
    latch_.CR = DmaStream::kChannel5 | DmaStream::kCircular | DmaStream::kPeripheral32 | DmaStream::kMemory32 |
                DmaStream::kHighPriority | DmaStream::kEnable;
  }

  Timer& registers_;
  std::uint32_t probe_trigger_;
  DmaStream& latch_;
  Pin receivers_fault_;
  volatile std::uint32_t latched_ = 0;  // written by DMA
};
static_assert(IndexedEncoder<EncoderTimer> && LatchedEncoder<EncoderTimer> && MonitoredEncoder<EncoderTimer>);

}  // namespace hal::stm32f4
