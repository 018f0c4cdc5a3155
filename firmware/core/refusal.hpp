// Reasons for which the core refuses parameters, limits and moves.
#pragma once

#include <cstdint>

namespace firmware {

/// The low twelve bits are the id of the parameter concerned; 0: none.
enum class Refusal : std::uint16_t {
  none = 0,
  sample_period = 17,              ///< not above 0
  lead = 18,                       ///< not above 0
  encoder_resolution = 19,         ///< not above 0
  dac_resolution = 20,             ///< not above 0
  dac_limit = 21,                  ///< below 2 or above 2^23 steps of the converter
  tachometer_gain = 33,            ///< gain zero, or gain or offset not finite, although a tachometer is fitted
  drive_model = 48,                ///< Ad12, Bd1 or Bd2 not above 0, or Ad22 outside (0, 1]
  kalman_gain = 64,                ///< not finite
  estimator_poles = 1 << 12 | 64,  ///< unstable, undamped or slow (control/pole_check.hpp)
  state_feedback = 80,             ///< not finite
  loop_poles = 1 << 12 | 80,       ///< as for the estimator
  friction_curve = 112,            ///< a magnitude below 0, or not finite
  friction_blend = 122,            ///< not above 0 although friction feed-forward is on
  velocity_limit = 128,            ///< not above 0, or outside the references' range (motion/motion_limits.hpp)
  acceleration_limit = 129,        ///< likewise
  jerk_limit = 130,                ///< likewise
  jerk_time = 1 << 12 | 130,       ///< acceleration / jerk is so long that one ramp would pass 2^14 counts a sample
  fault_deceleration = 131,        ///< outside the references' range, or with too long a ramp, as for jerk_time
  following_error = 144,           ///< floor not above 0, or share below 0; either above its ceiling
  disagreement = 146,              ///< floor not above 0, share outside 0..1, or jump not above the floor; ceilings
  overspeed = 149,                 ///< not above the velocity limit and the encoder's steps, or above its ceiling
  polarity_command = 150,          ///< not above 0, or above nine tenths of the converter's limit
  travel = 152,                    ///< minimum not below maximum
  saturation_time = 153,           ///< not above 0 or above 1 s
  oscillation = 154,               ///< not above 0, or so large that an unstable loop would not be found
  cogging = 179,                   ///< on, and an amplitude not finite, or a period not above two counts
  presliding = 193,                ///< on, and the stiffness not above 0 or the damping below 0
  position_friction = 211,         ///< as for cogging
  backlash = 225,                  ///< on, and the gap not above 0, or gap or wind-up 2^10 counts or more
  backlash_crossing = 226,         ///< on, and not 1..4096 samples
  homing = 241,           ///< not by an operator, and a velocity 0, or creep velocity or a distance not above 0
  amplifier_ready = 247,  ///< the ready input on, but no time for it; or a time below 0
  brake_feedback = 248,   ///< a brake, but neither tachometer nor fault input to detect a dead encoder at rest
  index_spacing = 251,    ///< below 0
  filters = 273,          ///< on, and not below 0.45 of the rate; or the loop is not stable with them
  pitch_crossing = 289,   ///< on, and not 1..4096 samples
  controller_is_enabled = 1 << 12,  ///< parameters change only while the axis is disabled
  move_too_long = 2 << 12,          ///< more than 2^30 samples: raise the velocity limit or split the move
  outside_travel = 3 << 12,         ///< the target is beyond a limit of travel
  path_not_open = 4 << 12,
  path_full = 5 << 12,            ///< no room for another node: send it later
  path_too_fast = 6 << 12,        ///< a node beyond an axis's limits; its word or duration is out of range
  path_ends_in_motion = 7 << 12,  ///< the last node, and it is not at rest
  path_headroom = 8 << 12,        ///< a node claims more than its geometry leaves
};

constexpr std::uint16_t parameter_behind(Refusal refusal) {
  return static_cast<std::uint16_t>(static_cast<unsigned>(refusal) & 0xFFF);
}

}  // namespace firmware
