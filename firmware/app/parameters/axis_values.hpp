// From named values to what the control core takes.
#pragma once

#include "firmware/app/parameters/parameter_values.hpp"
#include "firmware/core/axis_parameters.hpp"
#include "firmware/core/fixed_units.hpp"

namespace firmware {

namespace axis_values {

constexpr AxisParameters<float> in_single_precision(const AxisValues& v) {
  const float volts_per_effort = 1.0F / v.get<"drive.effort_per_volt">();
  AxisParameters<float> p;
  p.sample_period_s = v.get<"drive.sample_period">();
  p.lead = v.get<"drive.lead">();
  p.encoder_resolution = v.get<"drive.encoder_resolution">();
  p.dac_resolution_V = v.get<"drive.dac_resolution">();
  p.dac_limit_V = v.get<"drive.dac_limit">();
  p.tachometer_fitted = v.get<"tachometer.fitted">();
  p.tachometer_gain = v.get<"tachometer.gain">();
  p.tachometer_offset = v.get<"tachometer.offset">();
  p.drive = {v.get<"model.a12">(), v.get<"model.a22">(), v.get<"model.b1">(), v.get<"model.b2">()};
  p.Kobs = {{{v.get<"kalman.k11">(), v.get<"kalman.k12">()},
             {v.get<"kalman.k21">(), v.get<"kalman.k22">()},
             {v.get<"kalman.k31">(), v.get<"kalman.k32">()}}};
  p.Kc = {v.get<"feedback.k1">(), v.get<"feedback.k2">()};
  p.friction.positive = {v.get<"friction.static_positive">() * volts_per_effort,
                         v.get<"friction.coulomb_positive">() * volts_per_effort,
                         v.get<"friction.viscous_positive">() * volts_per_effort, v.get<"friction.omega1_positive">(),
                         v.get<"friction.omega2_positive">()};
  p.friction.negative = {v.get<"friction.static_negative">() * volts_per_effort,
                         v.get<"friction.coulomb_negative">() * volts_per_effort,
                         v.get<"friction.viscous_negative">() * volts_per_effort, v.get<"friction.omega1_negative">(),
                         v.get<"friction.omega2_negative">()};
  p.friction.blend_velocity_rad_s = v.get<"friction.blend">();
  p.friction_feedforward_on = v.get<"feedforward.friction">();
  p.disturbance_cancellation_on = v.get<"feedback.cancel_disturbance">();
  p.zero_phase_feedforward_on = v.get<"feedforward.zero_phase">();
  p.velocity_limit = v.get<"limits.velocity">();
  p.acceleration_limit = v.get<"limits.acceleration">();
  p.jerk_limit = v.get<"limits.jerk">();
  return p;
}

}  // namespace axis_values

/// In the units of `Scalar`: mm (m), rad/s (m/s) and V in floating point, those of fixed_units.hpp in fixed point. The
/// values have passed check_value().
template <typename Scalar>
constexpr AxisParameters<Scalar> axis_parameters(const AxisValues& values) {
  if constexpr (std::is_same_v<Scalar, float>) {
    return axis_values::in_single_precision(values);
  } else {
    return to_fixed(axis_values::in_single_precision(values));
  }
}

}  // namespace firmware
