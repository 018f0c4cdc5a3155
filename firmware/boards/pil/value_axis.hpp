// The hardware interface of one axis as plain values: the caller sets the readings and reads the converter's codes.
#pragma once

#include <cstdint>
#include <utility>

#include "hal/axis_hal.hpp"
#include "hal/limit_inputs.hpp"

namespace firmware::boards {

enum class OutputEdge : std::uint8_t { enable_on = 1, enable_off = 2, brake_released = 3, brake_applied = 4 };

class ValueAxis {
 public:
  struct Encoder {
    hal::EncoderReading reading;
    hal::IndexReading index;
    bool faulted = false;
    hal::EncoderReading read() const { return {reading.counts, reading.valid}; }
    bool is_faulted() const { return faulted; }
    hal::IndexReading read_index() { return std::exchange(index, {}); }
  };
  struct Tachometer {
    hal::TachometerReading reading;
    hal::TachometerReading read() const { return {reading.code, reading.valid}; }
  };
  struct Dac {
    std::int32_t code = 0;
    std::uint32_t writes = 0;
    bool write(std::int32_t value) {
      code = value;
      ++writes;
      return true;
    }
    bool is_healthy() const { return true; }
  };
  struct Enable {
    bool on = false;
    bool faulted = false;
    bool ready = true;         ///< while enabled
    bool ready_stuck = false;  ///< remains ready without an enable
    bool brake_released = false;
    std::uint32_t edges = 0;  ///< of both outputs since it was cleared, in their order: OutputEdge, the last one lowest
    void set(bool value) {
      if (value != on) note(value ? OutputEdge::enable_on : OutputEdge::enable_off);
      on = value;
    }
    bool is_faulted() const { return faulted; }
    bool is_ready() const { return ready && (on || ready_stuck); }
    void release_brake(bool released) {
      if (released != brake_released) note(released ? OutputEdge::brake_released : OutputEdge::brake_applied);
      brake_released = released;
    }
    void note(OutputEdge edge) { edges = edges << 4 | static_cast<std::uint32_t>(edge); }
  };
  struct Limits {
    hal::LimitState state;
    hal::LimitState read() const { return state; }
  };

  Encoder& encoder() { return encoder_; }
  Tachometer& tachometer() { return tachometer_; }
  Dac& dac() { return dac_; }
  Enable& drive_enable() { return enable_; }
  Limits& limits() { return limits_; }

 private:
  Encoder encoder_;
  Tachometer tachometer_;
  Dac dac_;
  Enable enable_;
  Limits limits_;
};
static_assert(hal::AxisHal<ValueAxis>);

}  // namespace firmware::boards
