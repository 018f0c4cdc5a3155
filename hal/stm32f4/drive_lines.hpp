// The digital lines of one drive: enable out, fault and switches in.
#pragma once

#include <initializer_list>

#include "hal/drive_enable.hpp"
#include "hal/emergency_stop.hpp"
#include "hal/limit_inputs.hpp"
#include "hal/stm32f4/pin.hpp"

namespace hal::stm32f4 {

/// Enable: high lets the amplifier drive, through the contact of the emergency-stop relay. Fault: the amplifier's
/// contact pulls low while all is well, so an open wire reads as a fault.
class DriveLines {
 public:
  DriveLines(Pin enable, Pin fault) : enable_(enable), fault_(fault) {}
  void start() {
    enable_.make_output(false);
    fault_.make_input(Pull::up);
  }
  void set(bool on) { enable_.set(on); }
  bool is_faulted() { return fault_.read(); }

 private:
  Pin enable_;
  Pin fault_;
};
static_assert(DriveEnable<DriveLines>);

/// End switches open when actuated; the home switch closes to ground.
class SwitchInputs {
 public:
  SwitchInputs(Pin positive_end, Pin negative_end, Pin home)
      : positive_end_(positive_end), negative_end_(negative_end), home_(home) {}
  void start() {
    for (const Pin& pin : {positive_end_, negative_end_, home_}) pin.make_input(Pull::up);
  }
  LimitState read() { return {positive_end_.read(), negative_end_.read(), !home_.read()}; }

 private:
  Pin positive_end_;
  Pin negative_end_;
  Pin home_;
};
static_assert(LimitInputs<SwitchInputs>);

/// Follows the stop circuit: closed pulls low, open or broken reads high.
class StopInput {
 public:
  explicit StopInput(Pin pin) : pin_(pin) {}
  void start() { pin_.make_input(Pull::up); }
  bool is_pressed() { return pin_.read(); }

 private:
  Pin pin_;
};
static_assert(EmergencyStop<StopInput>);

}  // namespace hal::stm32f4
