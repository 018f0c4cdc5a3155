// Emergency-stop input, which also acts in hardware, and the relay that cuts the power after a delayed stop.
#pragma once

#include <concepts>

namespace hal {

/// Contract: `is_pressed()` is true while the stop circuit is open, which includes a broken wire. Never waits.
template <typename T>
concept EmergencyStop = requires(T& stop) {
  { stop.is_pressed() } -> std::same_as<bool>;
};

/// A relay in the amplifiers' power. Contract: `close(false)` cuts the power; open after reset. Never waits.
template <typename T>
concept PowerRelay = requires(T& relay, bool closed) {
  { relay.close(closed) } -> std::same_as<void>;
};

}  // namespace hal
