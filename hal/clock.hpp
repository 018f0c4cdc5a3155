// Free-running time, for time-outs and for measuring how long the control interrupt takes.
#pragma once

#include <concepts>
#include <cstdint>

namespace hal {

/// Contract: `now_us()` counts microseconds modulo 2^32 (71.6 minutes) and never goes back. Differences modulo 2^32 are
/// durations. The control law does not use the time: its period is a parameter.
template <typename T>
concept Clock = requires(T& clock) {
  { clock.now_us() } -> std::same_as<std::uint32_t>;
};

}  // namespace hal
