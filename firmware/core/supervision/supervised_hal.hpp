// Requirements of a supervised axis on its hardware.
#pragma once

#include <type_traits>
#include <utility>

#include "hal/axis_hal.hpp"
#include "hal/limit_inputs.hpp"

namespace firmware {

/// An axis's hardware and its switches.
template <typename T>
concept SupervisedHal = hal::AxisHal<T> && requires(T& axis) {
  requires hal::LimitInputs<std::remove_reference_t<decltype(axis.limits())>>;
};

/// For use without interrupts.
struct NoShutOut {};

/// Limits that the motion reached without a fault.
struct LimitingReasons {
  bool saturated = false;         ///< the D/A converter is at its limit
  bool velocity_limited = false;  ///< a jog exceeded the velocity limit and was reduced to it
};

template <typename Hal>
inline constexpr bool kHasIndexPulse =
    hal::IndexedEncoder<std::remove_reference_t<decltype(std::declval<Hal&>().encoder())>>;

}  // namespace firmware
