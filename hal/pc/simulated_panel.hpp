// Inputs of the simulated board that its axes share: time, emergency stop, supply.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "hal/clock.hpp"
#include "hal/emergency_stop.hpp"
#include "hal/probe.hpp"
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

/// A wall across an axis: the probe touches it at this travel and beyond.
struct SimulatedSurface {
  std::size_t axis = 0;
  double travel = 0.0;      ///< mm (m)
  bool is_upwards = false;  ///< beyond: at more travel
  bool touches(double at) const { return is_upwards ? at >= travel : at <= travel; }
};

/// Its contact closes when the probe touches.
class SimulatedProbe {
 public:
  bool is_closed() const { return is_closed_; }
  void arm(bool closes) {
    armed_for_ = closes;
    has_latched_ = false;
  }
  bool has_latched() const { return has_latched_; }

  /// True if this edge latches.
  bool turn(bool closed) {
    const bool latches = closed != is_closed_ && armed_for_ == closed && !has_latched_;
    is_closed_ = closed;
    has_latched_ = has_latched_ || latches;
    return latches;
  }

 private:
  std::optional<bool> armed_for_;
  bool is_closed_ = false, has_latched_ = false;
};

static_assert(ProbeInput<SimulatedProbe>);
static_assert(Clock<SimulatedClock>);
static_assert(EmergencyStop<SimulatedEmergencyStop>);
static_assert(PowerRelay<SimulatedRelay>);
static_assert(Supply<SimulatedSupply>);

}  // namespace hal::pc
