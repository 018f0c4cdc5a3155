// Touch probe: an input whose edge latches the encoders.
#pragma once

#include <concepts>

namespace hal {

/// Contract: the first edge to this level after arm() latches the counters of all encoders at that instant
/// (LatchedEncoder); further edges, such as a contact's bouncing, change nothing before the next arm(). `is_closed()`
/// samples the input: its contact is closed. A broken wire is open. No call waits.
template <typename T>
concept ProbeInput = requires(T& probe, const T& same, bool closes) {
  { probe.is_closed() } -> std::same_as<bool>;
  { probe.arm(closes) } -> std::same_as<void>;
  { same.has_latched() } -> std::same_as<bool>;
};

}  // namespace hal
