// What one control period saw and did.
#pragma once

#include <cstdint>

#include "firmware/core/axis_fault.hpp"
#include "firmware/core/count_position.hpp"
#include "firmware/core/kalman_estimator.hpp"

namespace firmware {

/// Plain data, filled anew by every step; lengths in mm (m), velocities in rad/s (m/s).
template <typename Scalar>
struct AxisTelemetry {
  std::int64_t encoder_counts = 0;
  Scalar tachometer_velocity{};     ///< calibrated reading; 0 without a tachometer
  CountPosition reference{};        ///< xref(k), counts
  Scalar reference_velocity{};      ///< wref(k), eq. (52)
  Scalar position_error{};          ///< xref(k) - x_hat(k)
  AxisEstimate<Scalar> estimate{};  ///< x_hat, w_hat, d_hat (V)
  Scalar friction_V{};              ///< friction feed-forward contained in the control signal
  Scalar control_V{};               ///< u(k) before limits and rounding
  std::int32_t dac_code = 0;        ///< what the converter was given
  bool saturated = false;           ///< u(k) was beyond the converter's range
  bool enabled = false;
  AxisFault fault = AxisFault::none;
};

}  // namespace firmware
