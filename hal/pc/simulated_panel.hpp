// Inputs of the simulated board that its axes share: time, emergency stop, supply.
#pragma once

#include <cstdint>

#include "hal/clock.hpp"
#include "hal/emergency_stop.hpp"
#include "hal/supply.hpp"

namespace hal::pc {

/// Simulated time, advanced by the code that runs the plants.
class SimulatedClock {
 public:
  void advance_us(std::uint32_t duration_us) { now_us_ += duration_us; }
  std::uint32_t now_us() const { return now_us_; }

 private:
  std::uint32_t now_us_ = 0;
};

class SimulatedEmergencyStop {
 public:
  void press() { pressed_ = true; }
  void release() { pressed_ = false; }
  bool is_pressed() const { return pressed_; }

 private:
  bool pressed_ = false;
};

class SimulatedRelay {
 public:
  void close(bool closed) { is_closed_ = closed; }
  bool is_closed() const { return is_closed_; }

 private:
  bool is_closed_ = false;
};

class SimulatedSupply {
 public:
  void set_low(bool is_low) { is_low_ = is_low; }
  bool is_low() const { return is_low_; }

 private:
  bool is_low_ = false;
};

static_assert(Clock<SimulatedClock>);
static_assert(EmergencyStop<SimulatedEmergencyStop>);
static_assert(PowerRelay<SimulatedRelay>);
static_assert(Supply<SimulatedSupply>);

}  // namespace hal::pc
