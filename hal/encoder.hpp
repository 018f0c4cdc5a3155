// Incremental encoder on a quadrature counter.
#pragma once

#include <concepts>
#include <cstdint>

namespace hal {

/// One reading. `counts` runs modulo 2^32 in both directions; the difference of two readings, taken modulo 2^32 and
/// read as a signed number, is the travel between them as long as that stays below 2^31 counts.
struct EncoderReading {
  std::uint32_t counts = 0;
  bool valid = false;  ///< false: wire break, illegal edge or bus error; `counts` must then not be used
};

/// The counter at an index pulse.
struct IndexReading {
  std::uint32_t counts = 0;
  bool seen = false;    ///< a pulse occurred since the last call
  bool missed = false;  ///< more than one occurred; `counts` belongs to the last
};

/// Contract: `read()` returns at once the counter at one instant of the control period, best at an instant that
/// hardware chooses. Positive counts are positive travel of the axis. A reading never goes back to an earlier value by
/// itself (no reset at the index pulse). An error is an invalid reading; it lasts as long as its cause.
template <typename T>
concept Encoder = requires(T& encoder) {
  { encoder.read() } -> std::same_as<EncoderReading>;
};

/// An encoder whose line receivers report broken wires. Contract: `is_faulted()` returns at once whether they do,
/// without debouncing. A broken wire between receivers and board reads as a fault.
template <typename T>
concept MonitoredEncoder = Encoder<T> && requires(T& encoder) {
  { encoder.is_faulted() } -> std::same_as<bool>;
};

/// An encoder with an index pulse. Contract: `read_index()` returns at once, and clears what it has reported.
template <typename T>
concept IndexedEncoder = Encoder<T> && requires(T& encoder) {
  { encoder.read_index() } -> std::same_as<IndexReading>;
};

/// An encoder whose counter a probe's edge latches (ProbeInput). Contract: `read_latch()` returns at once the counter
/// at the last edge that latched it; valid: one came since the last call.
template <typename T>
concept LatchedEncoder = Encoder<T> && requires(T& encoder) {
  { encoder.read_latch() } -> std::same_as<EncoderReading>;
};

}  // namespace hal
