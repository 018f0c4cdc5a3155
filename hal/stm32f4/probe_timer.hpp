// Touch probe on channel 1 of a timer, whose trigger output latches the encoders. RM0090, sections 18.3.14 and 18.3.15.
#pragma once

#include "hal/probe.hpp"
#include "hal/stm32f4/pin.hpp"

namespace hal::stm32f4 {

/// The first edge starts the counter (trigger mode), and the counter's running is the trigger output. While it runs,
/// further edges start nothing. The filter is the one of the encoders' lines, so the delays are equal. The contact
/// pulls the pin low.
class ProbeTimer {
 public:
  ProbeTimer(Timer& registers, Pin pin) : registers_(registers), pin_(pin) {}

  void start() {
    registers_.CCMR1 = Timer::kFilteredPin;
    registers_.CR2 = Timer::kTriggerWhileEnabled;
    registers_.SMCR = Timer::kFromInput1;
  }

  bool is_closed() { return !pin_.read(); }

  void arm(bool closes) {
    registers_.SMCR = Timer::kFromInput1;  // no trigger while the edge's polarity changes
    registers_.CR1 = 0;
    registers_.CCER = closes ? Timer::kInput1Falls : 0;
    registers_.SMCR = Timer::kFromInput1 | Timer::kStartOnTrigger;
  }

  bool has_latched() const { return (registers_.CR1 & Timer::kEnable) != 0; }

 private:
  Timer& registers_;
  Pin pin_;
};
static_assert(ProbeInput<ProbeTimer>);

}  // namespace hal::stm32f4
