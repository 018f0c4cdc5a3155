// Emergency-stop input. It acts in hardware, too; software only reads it.
#pragma once

#include <concepts>

namespace hal {

/// Contract: `is_pressed()` is true while the stop circuit is open, which includes a broken wire. Never waits.
template <typename T>
concept EmergencyStop = requires(T& stop) {
  { stop.is_pressed() } -> std::same_as<bool>;
};

}  // namespace hal
