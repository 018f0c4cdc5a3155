// Checks parameters, and turns limits into the units of references.
#pragma once

#include "firmware/core/axis_parameters.hpp"
#include "firmware/core/motion/motion_limits.hpp"

namespace firmware {

namespace parameter_check {

template <typename Scalar>
constexpr bool is_valid(const FrictionDirection<Scalar>& direction) {
  const auto is_magnitude = [](Scalar value) { return value >= Scalar(0) && ScalarTraits<Scalar>::is_finite(value); };
  return is_magnitude(direction.static_V) && is_magnitude(direction.coulomb_V) &&
         is_magnitude(direction.omega1_rad_s) && is_magnitude(direction.omega2_rad_s) &&
         ScalarTraits<Scalar>::is_finite(direction.viscous_V_s_per_rad);
}

template <typename Scalar>
constexpr bool is_valid(const TravelHarmonic<Scalar>& harmonic) {
  return harmonic.is_zero() ||
         (ScalarTraits<Scalar>::is_finite(harmonic.cosine) && ScalarTraits<Scalar>::is_finite(harmonic.sine) &&
          harmonic.turns_per_count > 0 && harmonic.turns_per_count < kOneCount / 2);
}

/// Checks only what is switched on.
template <typename Scalar>
constexpr Refusal check_compensation(const CompensationParameters<Scalar>& c) {
  if (c.cogging_on)
    for (const TravelHarmonic<Scalar>& harmonic : c.cogging_V)
      if (!is_valid(harmonic)) return Refusal::cogging;
  if (c.position_friction_on && !is_valid(c.position_friction)) return Refusal::position_friction;
  const PreslidingParameters<Scalar>& contact = c.presliding;
  if (contact.on && (!is_positive(contact.stiffness_V_per_rad) || !(contact.damping_V_s_per_rad >= Scalar(0)) ||
                     !ScalarTraits<Scalar>::is_finite(contact.damping_V_s_per_rad)))
    return Refusal::presliding;
  const auto is_crossing_time = [](std::int32_t samples) { return samples >= 1 && samples <= CrossingRamp::kLongest; };
  if (c.pitch.on && !is_crossing_time(c.pitch.crossing_samples)) return Refusal::pitch_crossing;
  if (!c.backlash.on) return Refusal::none;
  constexpr Increment kWidest = kOneCount << 10;  // fits a fixed-point scalar
  if (c.backlash.gap <= 0 || c.backlash.gap >= kWidest || c.backlash.wind_up < 0 || c.backlash.wind_up >= kWidest)
    return Refusal::backlash;
  return is_crossing_time(c.backlash.crossing_samples) ? Refusal::none : Refusal::backlash_crossing;
}

/// Length per second^order as an increment per sample^order; 0 if it is out of range.
template <typename Scalar>
constexpr Increment motion(Scalar limit, Scalar count_length, Scalar sample_period_s, int order) {
  Scalar counts = limit / count_length;
  for (int i = 0; i < order; ++i) counts = counts * sample_period_s;
  constexpr Scalar kMost = Scalar(16384);  // 2^14 counts
  return counts > Scalar(0) && counts <= kMost ? ScalarTraits<Scalar>::to_increment(counts) : 0;
}

}  // namespace parameter_check

template <typename Scalar>
constexpr MotionLimits motion_limits(const AxisParameters<Scalar>& p) {
  if (p.motion.velocity != 0 || p.motion.acceleration != 0 || p.motion.jerk != 0) return p.motion;
  using parameter_check::motion;
  // This also refuses a value out of range.
  const Increment hard = motion(p.fault_deceleration, p.encoder_resolution, p.sample_period_s, 2);
  const Increment fault_deceleration =
      p.fault_deceleration > p.acceleration_limit && hard == 0 ? kMostMotion + 1 : hard;
  return {.velocity = motion(p.velocity_limit, p.encoder_resolution, p.sample_period_s, 1),
          .acceleration = motion(p.acceleration_limit, p.encoder_resolution, p.sample_period_s, 2),
          .jerk = motion(p.jerk_limit, p.encoder_resolution, p.sample_period_s, 3),
          .fault_deceleration = fault_deceleration};
}

/// The first error.
template <typename Scalar>
constexpr Refusal check(const AxisParameters<Scalar>& p) {
  using Traits = ScalarTraits<Scalar>;
  if (!is_positive(p.sample_period_s)) return Refusal::sample_period;
  if (!is_positive(p.lead)) return Refusal::lead;
  if (!is_positive(p.encoder_resolution)) return Refusal::encoder_resolution;
  if (!is_positive(p.dac_resolution_V)) return Refusal::dac_resolution;
  constexpr Scalar kMostCodes = Scalar(8388608);  // 2^23: such codes are exact in a float
  const Scalar codes = p.dac_limit_V / p.dac_resolution_V;
  if (!(codes >= Scalar(2) && codes <= kMostCodes)) return Refusal::dac_limit;
  if (p.tachometer_fitted && !is_positive(p.tachometer_gain) && !is_positive(Scalar(0) - p.tachometer_gain))
    return Refusal::tachometer_gain;
  if (p.tachometer_fitted && !Traits::is_finite(p.tachometer_offset)) return Refusal::tachometer_gain;
  const DiscreteDrive<Scalar>& drive = p.drive;
  if (!is_positive(drive.Ad12) || !is_positive(drive.Bd1) || !is_positive(drive.Bd2) || !is_positive(drive.Ad22) ||
      drive.Ad22 > Scalar(1))
    return Refusal::drive_model;
  for (const auto& row : p.Kobs)
    for (const Scalar gain : row)
      if (!Traits::is_finite(gain)) return Refusal::kalman_gain;
  if (!Traits::is_finite(p.Kc[0]) || !Traits::is_finite(p.Kc[1])) return Refusal::state_feedback;
  if (p.friction_feedforward_on) {
    using parameter_check::is_valid;
    if (!is_valid(p.friction.positive) || !is_valid(p.friction.negative)) return Refusal::friction_curve;
    if (!is_positive(p.friction.blend_velocity_rad_s)) return Refusal::friction_blend;
  }
  const Refusal compensation = parameter_check::check_compensation(p.compensation);
  if (compensation != Refusal::none) return compensation;
  return check(motion_limits(p));
}

template <typename Scalar>
constexpr Refusal check_homing(const HomingParameters<Scalar>& h) {
  if (h.mode == HomingMode::none) return Refusal::none;
  const bool moves = is_positive(ScalarTraits<Scalar>::magnitude(h.velocity)) && is_positive(h.creep_velocity);
  return moves && h.travel > 0 && h.index_travel > 0 ? Refusal::none : Refusal::homing;
}

constexpr Refusal check_sequence(const DriveSequenceParameters& s) {
  const bool is_sound = s.amplifier_wait >= 0 && s.brake_release >= 0 && s.brake_application >= 0;
  return is_sound && (!s.ready_input || s.amplifier_wait > 0) ? Refusal::none : Refusal::amplifier_ready;
}

}  // namespace firmware
