// Converts velocities between the host's units (mm/s, rad/s, m/s) and those of a core that may compute in fixed point.
#pragma once

#include <type_traits>

#include "firmware/app/parameters/axis_values.hpp"
#include "firmware/core/fixed_units.hpp"

namespace firmware {

/// Velocity of a jog, mm/s (m/s).
template <typename Scalar>
Scalar to_core_travel_velocity(float velocity, const AxisValues& values) {
  if constexpr (std::is_same_v<Scalar, float>)
    return velocity;
  else
    return Scalar::from(velocity / FixedUnits<float>(axis_parameters<float>(values)).travel_velocity);
}

/// Velocity of the drive, rad/s (m/s).
template <typename Scalar>
float from_core_velocity(Scalar velocity, const AxisValues& values) {
  if constexpr (std::is_same_v<Scalar, float>)
    return velocity;
  else
    return static_cast<float>(velocity.raw()) / static_cast<float>(Scalar(1).raw()) *
           FixedUnits<float>(axis_parameters<float>(values)).velocity;
}

}  // namespace firmware
