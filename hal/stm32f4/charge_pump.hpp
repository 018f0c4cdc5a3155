// A square wave that says that control is alive: a charge pump outside makes it the supply of the enables, so that a
// processor that hangs, at either level, lets go of the drives.
#pragma once

#include "hal/stm32f4/pin.hpp"

namespace hal::stm32f4 {

class ChargePump {
 public:
  explicit constexpr ChargePump(Pin pin) : pin_(pin) {}
  void start() { pin_.make_output(false); }

  /// Once a control period, while all that must run runs: half the control rate.
  void beat() {
    level_ = !level_;
    pin_.set(level_);
  }

 private:
  Pin pin_;
  bool level_ = false;
};

}  // namespace hal::stm32f4
