// The digital lines of one drive: enable and brake out, fault, ready and switches in.
#pragma once

#include <initializer_list>

#include "hal/drive_enable.hpp"
#include "hal/emergency_stop.hpp"
#include "hal/limit_inputs.hpp"
#include "hal/stm32f4/pin.hpp"

namespace hal::stm32f4 {

/// Enable: high lets the amplifier drive, through the contact of the emergency-stop relay. Fault: the amplifier's
/// contact pulls low without a fault, so an open wire reads as a fault. Ready: its contact pulls low once it drives.
/// Brake: high releases it. Dynamic brake: low shorts the motor, or is the amplifier's own input for it; it is released
/// before the enable is set and applied after it has dropped.
class DriveLines {
 public:
  struct Pins {
    Pin enable, fault, ready, brake, dynamic_brake;
  };
  explicit DriveLines(const Pins& pins) : pins_(pins) {}
  void start() {
    pins_.enable.make_output(false);
    pins_.dynamic_brake.make_output(false);
    pins_.brake.make_output(false);
    pins_.fault.make_input(Pull::up);
    pins_.ready.make_input(Pull::up);
  }
  void set(bool on) {
    if (on) pins_.dynamic_brake.set(true);
    pins_.enable.set(on);
    if (!on) pins_.dynamic_brake.set(false);
  }
  bool is_faulted() { return pins_.fault.read(); }
  bool is_ready() { return !pins_.ready.read(); }
  void release_brake(bool released) { pins_.brake.set(released); }

 private:
  Pins pins_;
};
static_assert(DriveEnable<DriveLines> && ReadyInput<DriveLines> && BrakeOutput<DriveLines>);

/// End switches open when actuated; the home switch closes to ground.
class SwitchInputs {
 public:
  struct Pins {
    Pin positive_end, negative_end, home;
  };
  explicit SwitchInputs(const Pins& pins) : pins_(pins) {}
  void start() {
    for (const Pin& pin : {pins_.positive_end, pins_.negative_end, pins_.home}) pin.make_input(Pull::up);
  }
  LimitState read() {
    return {.positive_end = pins_.positive_end.read(),
            .negative_end = pins_.negative_end.read(),
            .home = !pins_.home.read()};
  }

 private:
  Pins pins_;
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

/// High closes the relay in the amplifiers' power.
class RelayOutput {
 public:
  explicit RelayOutput(Pin pin) : pin_(pin) {}
  void start() { pin_.make_output(false); }
  void close(bool closed) { pin_.set(closed); }

 private:
  Pin pin_;
};
static_assert(PowerRelay<RelayOutput>);

}  // namespace hal::stm32f4
