// Measurements and outputs of one control period.
#pragma once

#include <cstdint>

#include "firmware/core/arithmetic/count_position.hpp"
#include "firmware/core/axis_fault.hpp"
#include "firmware/core/control/kalman_estimator.hpp"

namespace firmware {

/// The part that a capture keeps. Lengths in mm (m), velocities in rad/s (m/s).
template <typename Scalar>
struct AxisSample {
  AxisEstimate<Scalar> estimate{};  ///< x_hat with the encoder's counts, w_hat, d_hat (V)
  Scalar tachometer_velocity{};     ///< calibrated reading; 0 without a tachometer
  Scalar reference_velocity{};      ///< wref(k), eq. (52)
  Scalar position_error{};          ///< xref(k) - x_hat(k)
  std::int32_t dac_code = 0;        ///< output of the converter
};

/// Plain data, rewritten by every step.
template <typename Scalar>
struct AxisTelemetry : AxisSample<Scalar> {
  std::int64_t encoder_counts = 0;
  std::int32_t encoder_travel = 0;  ///< counts since the last sample
  CountPosition reference{};        ///< xref(k), counts
  Scalar tracking_error{};          ///< xref(k) minus the encoder reading, independent of the estimate; mm (m)
  Scalar friction_V{};              ///< feed-forward of friction and cogging contained in the control signal
  Scalar output_V{};                ///< output of the converter, as a voltage
  Scalar feedback_V{};              ///< its part from errors of position and speed, without feed-forward
  Scalar control_V{};               ///< u(k) before limits and rounding
  bool saturated = false;           ///< u(k) was beyond the converter's range
  bool enabled = false;
  bool homed = false;  ///< encoder_counts are from home, not from the position at power-up
  AxisFault fault = AxisFault::none;
};

}  // namespace firmware
