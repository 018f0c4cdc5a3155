// All parameters of one axis: plain values, checked once, before they are used.
#pragma once

#include <cstdint>

#include "firmware/core/compensation/compensation_parameters.hpp"
#include "firmware/core/control/control_filter.hpp"
#include "firmware/core/control/discrete_drive.hpp"
#include "firmware/core/control/friction_feedforward.hpp"
#include "firmware/core/control/kalman_estimator.hpp"
#include "firmware/core/control/reference_feedforward.hpp"
#include "firmware/core/motion/homing.hpp"
#include "firmware/core/motion/motion_limits.hpp"
#include "firmware/core/supervision/drive_sequence.hpp"
#include "firmware/core/supervision/monitor_limits.hpp"

namespace firmware {

/// Every value is finite. Lengths are mm for a rotary drive and m for a linear one; velocities of the drive are rad/s
/// and m/s.
template <typename Scalar>
struct AxisParameters {
  Scalar sample_period_s{};          ///< Ts, > 0
  Scalar lead{};                     ///< rg, mm/rad; 1 for a linear drive; > 0
  Scalar encoder_resolution{};       ///< dx, mm (m) a count, > 0
  Scalar dac_resolution_V{};         ///< du, > 0
  Scalar dac_limit_V{};              ///< output range is -limit..+limit; 2 du .. 2^23 du
  bool tachometer_fitted = true;     ///< false: the estimate uses the encoder only
  bool encoder_fault_input = false;  ///< the encoder's line receivers report broken wires
  Scalar tachometer_gain{};          ///< rad/s (m/s) a code
  Scalar tachometer_offset{};        ///< rad/s (m/s) at code 0, subtracted

  DiscreteDrive<Scalar> drive{};
  KalmanGain<Scalar> Kobs{};
  StateFeedbackGain<Scalar> Kc{};
  FrictionParameters<Scalar> friction{};

  bool friction_feedforward_on = false;
  bool disturbance_cancellation_on = false;
  bool zero_phase_feedforward_on = false;  ///< off: the reference velocity alone, eqs. (50) and (52)

  // For SupervisedAxis; Axis alone has no monitors.
  HomingParameters<Scalar> homing{};
  DriveSequenceParameters sequence{};
  MonitorLimits<Scalar> monitors{};

  Scalar velocity_limit{};      ///< of references, mm/s (m/s)
  Scalar acceleration_limit{};  ///< mm/s^2 (m/s^2)
  Scalar jerk_limit{};          ///< mm/s^3 (m/s^3)
  Scalar fault_deceleration{};  ///< of the ramp after a fault; at least acceleration_limit
  /// These four as increments, if the scalar's resolution is too coarse: fixed point at a fast control rate resolves a
  /// jerk limit into a few steps only. Zero: computed from the scalars.
  MotionLimits motion{};

  FilterParameters<Scalar> filters{};             ///< notch, low-pass; of the feedback and of reference feed-forward
  CompensationParameters<Scalar> compensation{};  ///< comes last, because no control period reads it here
};

}  // namespace firmware
