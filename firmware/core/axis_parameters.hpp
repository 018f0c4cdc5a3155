// Everything that one axis is told: plain values, checked once, before they are used.
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
  Scalar sample_period_s{};       ///< Ts, > 0
  Scalar lead{};                  ///< rg, mm/rad; 1 for a linear drive; > 0
  Scalar encoder_resolution{};    ///< dx, mm (m) a count, > 0
  Scalar dac_resolution_V{};      ///< du, > 0
  Scalar dac_limit_V{};           ///< output range is -limit..+limit; 2 du .. 2^23 du
  bool tachometer_fitted = true;  ///< false: the estimate rests on the encoder alone
  Scalar tachometer_gain{};       ///< rad/s (m/s) a code
  Scalar tachometer_offset{};     ///< rad/s (m/s) at code 0, subtracted

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
  /// The three as increments, where the scalar cannot hold them closely enough: fixed point at a fast control rate has
  /// a few steps for a jerk limit. Zero: made of the scalars.
  MotionLimits motion{};

  FilterParameters<Scalar> filters{};             ///< notch, low-pass; of the feedback and of reference feed-forward
  CompensationParameters<Scalar> compensation{};  ///< last: no control period reads it here
};

enum class ParameterError : std::uint8_t {
  none = 0,
  sample_period = 1,           ///< not above 0
  lead = 2,                    ///< not above 0
  encoder_resolution = 3,      ///< not above 0
  dac_resolution = 4,          ///< not above 0
  dac_limit = 5,               ///< below 2 or above 2^23 steps of the converter
  tachometer_gain = 6,         ///< gain zero, or gain or offset not finite, although a tachometer is fitted
  drive_model = 7,             ///< Ad12, Bd1 or Bd2 not above 0, or Ad22 outside (0, 1]
  kalman_gain = 8,             ///< not finite
  state_feedback = 9,          ///< not finite
  friction_curve = 10,         ///< a magnitude below 0, or not finite
  friction_blend = 11,         ///< not above 0 although friction feed-forward is on
  velocity_limit = 12,         ///< not above 0, or outside the references' range (motion_limits.hpp)
  acceleration_limit = 13,     ///< likewise
  jerk_limit = 14,             ///< likewise
  jerk_time = 15,              ///< acceleration limit / jerk limit too long
  controller_is_enabled = 16,  ///< parameters change only while the axis is disabled
  following_error = 17,        ///< floor not above 0, or share below 0; either above its ceiling (axis_check.hpp)
  disagreement = 18,           ///< floor not above 0, share outside 0..1, or jump not above the floor; ceilings
  overspeed = 19,              ///< not above the velocity limit and the encoder's steps, or above its ceiling
  polarity_command = 20,       ///< not above 0, or above what the converter can put out, less a tenth
  travel = 21,                 ///< minimum not below maximum
  saturation_time = 22,        ///< not above 0 or above 1 s; or the capture's stride not above 0
  cogging = 23,                ///< on, and an amplitude not finite, or a period not above two counts
  position_friction = 24,      ///< likewise
  presliding = 25,             ///< on, and the stiffness not above 0 or the damping below 0
  backlash = 26,               ///< on, and the gap not above 0 or gap or wind-up of 2^10 counts and more
  backlash_crossing = 27,      ///< on, and not 1..4096 samples
  oscillation = 28,            ///< not above 0, or so much that an unstable loop would pass
  estimator_poles = 29,        ///< unstable, undamped or slow (pole_check.hpp)
  loop_poles = 30,             ///< likewise
  homing = 31,                 ///< not by an operator, and a velocity 0, creep or a way not above 0
  amplifier_ready = 32,        ///< the ready input on, and no time for it; or a time below 0
  index_spacing = 33,          ///< below 0
  filters = 34,                ///< on, and not below 0.45 of the rate; or the loop with them does not settle
};

}  // namespace firmware
