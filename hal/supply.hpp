// Whether the board's supply voltage is too low.
#pragma once

#include <concepts>

namespace hal {

/// Contract: `is_low()` is true while the supply is below the threshold at which the board can still stop its drives
/// along their ramps. Never waits.
template <typename T>
concept Supply = requires(T& supply) {
  { supply.is_low() } -> std::same_as<bool>;
};

}  // namespace hal
