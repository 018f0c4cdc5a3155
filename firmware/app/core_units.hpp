// Converts velocities and voltages between the host's units (mm/s, rad/s, m/s, V) and those of a core that may compute
// in fixed point.
#pragma once

#include <type_traits>

#include "firmware/app/parameters/axis_values.hpp"
#include "firmware/core/fixed_units.hpp"

namespace firmware {

inline FixedUnits<float> fixed_units(const AxisValues& v) {
  return {v.get<"drive.sample_period">(), v.get<"drive.lead">(), v.get<"drive.encoder_resolution">(),
          v.get<"drive.dac_resolution">()};
}

/// Velocity of a jog, mm/s (m/s).
template <typename Scalar>
Scalar to_core_travel_velocity(float velocity, const AxisValues& values) {
  if constexpr (std::is_same_v<Scalar, float>)
    return velocity;
  else
    return Scalar::from(velocity / fixed_units(values).travel_velocity);
}

namespace core_units {

template <typename Scalar>
float from_core(Scalar value, float FixedUnits<float>::*unit, const AxisValues& values) {
  if constexpr (std::is_same_v<Scalar, float>)
    return value;
  else
    return static_cast<float>(value.raw()) / static_cast<float>(Scalar(1).raw()) * (fixed_units(values).*unit);
}

}  // namespace core_units

/// Velocity of the drive, rad/s (m/s).
template <typename Scalar>
float from_core_velocity(Scalar velocity, const AxisValues& values) {
  return core_units::from_core(velocity, &FixedUnits<float>::velocity, values);
}

/// V.
template <typename Scalar>
float from_core_voltage(Scalar volts, const AxisValues& values) {
  return core_units::from_core(volts, &FixedUnits<float>::volts, values);
}

}  // namespace firmware
