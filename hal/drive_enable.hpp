// Enable line to the amplifier and the fault line that comes back.
#pragma once

#include <concepts>

namespace hal {

/// Contract: `set(true)` lets the amplifier drive current, `set(false)` takes the current away within the amplifier's
/// own reaction time; off after reset. `is_faulted()` is the amplifier's own fault signal, debounced by nobody; a
/// broken wire reads as a fault. Neither call waits.
template <typename T>
concept DriveEnable = requires(T& drive, bool on) {
  { drive.set(on) } -> std::same_as<void>;
  { drive.is_faulted() } -> std::same_as<bool>;
};

}  // namespace hal
