// Enable line to the amplifier, and the fault line from it.
#pragma once

#include <concepts>

namespace hal {

/// Contract: `set(true)` lets the amplifier drive current, `set(false)` removes the current within the amplifier's
/// reaction time; off after reset. `is_faulted()` is the amplifier's fault signal, not debounced; a broken wire reads
/// as a fault. Neither call waits.
template <typename T>
concept DriveEnable = requires(T& drive, bool on) {
  { drive.set(on) } -> std::same_as<void>;
  { drive.is_faulted() } -> std::same_as<bool>;
};

/// An amplifier with a ready signal. Contract: `is_ready()` is that signal; a broken wire reads as not ready.
template <typename T>
concept ReadyInput = requires(T& drive) {
  { drive.is_ready() } -> std::same_as<bool>;
};

/// A brake that holds without current. Contract: `release_brake(true)` releases it, `release_brake(false)` applies it;
/// applied after reset. The call does not wait.
template <typename T>
concept BrakeOutput = requires(T& drive, bool released) {
  { drive.release_brake(released) } -> std::same_as<void>;
};

}  // namespace hal
