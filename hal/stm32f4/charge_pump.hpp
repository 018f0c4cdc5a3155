// A square wave that shows that the control works. An external charge pump makes the supply of the enables from it, so
// a processor that hangs, with the pin at either level, disables the drives.
#pragma once

#include "hal/stm32f4/pin.hpp"

namespace hal::stm32f4 {

class ChargePump {
 public:
  explicit constexpr ChargePump(Pin pin) : pin_(pin) {}
  void start() { pin_.make_output(false); }

  /// Call it once per control period while everything required runs: half the control rate.
  void beat() {
    level_ = !level_;
    pin_.set(level_);
  }

 private:
  Pin pin_;
  bool level_ = false;
};

}  // namespace hal::stm32f4
