// What the simulated board shares between its axes: time and the emergency stop.
#pragma once

#include <cstdint>

#include "hal/clock.hpp"
#include "hal/emergency_stop.hpp"

namespace hal::pc {

/// Simulated time, advanced by whoever runs the plants.
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

static_assert(Clock<SimulatedClock>);
static_assert(EmergencyStop<SimulatedEmergencyStop>);

}  // namespace hal::pc
