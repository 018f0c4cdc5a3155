// Tachometer on an A/D converter.
#pragma once

#include <concepts>
#include <cstdint>

namespace hal {

/// One conversion. The code is signed and proportional to the shaft's speed; its gain and offset belong to the axis's
/// parameters, because they are calibrated on the machine.
struct TachometerReading {
  std::int32_t code = 0;
  bool valid = false;  ///< false: no new conversion since the last reading, input out of range, or none fitted
};

/// Contract: `read()` returns the conversion that belongs to this control period and never waits for one. Positive
/// codes are positive speed before calibration. |code| < 2^24, so that a float holds it exactly.
template <typename T>
concept Tachometer = requires(T& tachometer) {
  { tachometer.read() } -> std::same_as<TachometerReading>;
};

}  // namespace hal
