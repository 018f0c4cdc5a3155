// Checks parameters, and turns limits into the units of references.
#pragma once

#include "firmware/core/axis_parameters.hpp"
#include "firmware/core/motion/motion_limits.hpp"

namespace firmware {

namespace parameter_check {

template <typename Scalar>
constexpr bool is_positive(Scalar value) {
  return value > Scalar(0) && ScalarTraits<Scalar>::is_finite(value);
}

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

/// Only what is switched on must make sense.
template <typename Scalar>
constexpr ParameterError check_compensation(const CompensationParameters<Scalar>& c) {
  if (c.cogging_on)
    for (const TravelHarmonic<Scalar>& harmonic : c.cogging_V)
      if (!is_valid(harmonic)) return ParameterError::cogging;
  if (c.position_friction_on && !is_valid(c.position_friction)) return ParameterError::position_friction;
  const PreslidingParameters<Scalar>& contact = c.presliding;
  if (contact.on && (!is_positive(contact.stiffness_V_per_rad) || !(contact.damping_V_s_per_rad >= Scalar(0)) ||
                     !ScalarTraits<Scalar>::is_finite(contact.damping_V_s_per_rad)))
    return ParameterError::presliding;
  if (!c.backlash.on) return ParameterError::none;
  constexpr Increment kWidest = kOneCount << 10;  // a scalar of fixed point holds it
  if (c.backlash.gap <= 0 || c.backlash.gap >= kWidest || c.backlash.wind_up < 0 || c.backlash.wind_up >= kWidest)
    return ParameterError::backlash;
  const std::int32_t crossing = c.backlash.crossing_samples;
  return crossing < 1 || crossing > BacklashCrossing::kLongestCrossing ? ParameterError::backlash_crossing
                                                                       : ParameterError::none;
}

/// Length per second^order as an increment per sample^order; 0 where it is out of range.
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
  return {motion(p.velocity_limit, p.encoder_resolution, p.sample_period_s, 1),
          motion(p.acceleration_limit, p.encoder_resolution, p.sample_period_s, 2),
          motion(p.jerk_limit, p.encoder_resolution, p.sample_period_s, 3)};
}

/// The first thing that is wrong, in the order of the enumeration.
template <typename Scalar>
constexpr ParameterError check(const AxisParameters<Scalar>& p) {
  using parameter_check::is_positive;
  using Traits = ScalarTraits<Scalar>;
  if (!is_positive(p.sample_period_s)) return ParameterError::sample_period;
  if (!is_positive(p.lead)) return ParameterError::lead;
  if (!is_positive(p.encoder_resolution)) return ParameterError::encoder_resolution;
  if (!is_positive(p.dac_resolution_V)) return ParameterError::dac_resolution;
  constexpr Scalar kMostCodes = Scalar(8388608);  // 2^23: such codes are exact in a float
  const Scalar codes = p.dac_limit_V / p.dac_resolution_V;
  if (!(codes >= Scalar(2) && codes <= kMostCodes)) return ParameterError::dac_limit;
  if (p.tachometer_fitted && !is_positive(p.tachometer_gain) && !is_positive(Scalar(0) - p.tachometer_gain))
    return ParameterError::tachometer_gain;
  if (p.tachometer_fitted && !Traits::is_finite(p.tachometer_offset)) return ParameterError::tachometer_gain;
  const DiscreteDrive<Scalar>& drive = p.drive;
  if (!is_positive(drive.Ad12) || !is_positive(drive.Bd1) || !is_positive(drive.Bd2) || !is_positive(drive.Ad22) ||
      drive.Ad22 > Scalar(1))
    return ParameterError::drive_model;
  for (const auto& row : p.Kobs)
    for (const Scalar gain : row)
      if (!Traits::is_finite(gain)) return ParameterError::kalman_gain;
  if (!Traits::is_finite(p.Kc[0]) || !Traits::is_finite(p.Kc[1])) return ParameterError::state_feedback;
  if (p.friction_feedforward_on) {
    using parameter_check::is_valid;
    if (!is_valid(p.friction.positive) || !is_valid(p.friction.negative)) return ParameterError::friction_curve;
    if (!is_positive(p.friction.blend_velocity_rad_s)) return ParameterError::friction_blend;
  }
  const ParameterError compensation = parameter_check::check_compensation(p.compensation);
  if (compensation != ParameterError::none) return compensation;
  switch (check(motion_limits(p))) {
    case MotionLimitError::velocity_out_of_range:
      return ParameterError::velocity_limit;
    case MotionLimitError::acceleration_out_of_range:
      return ParameterError::acceleration_limit;
    case MotionLimitError::jerk_out_of_range:
      return ParameterError::jerk_limit;
    case MotionLimitError::jerk_time_out_of_range:
      return ParameterError::jerk_time;
    case MotionLimitError::none:
      break;
  }
  return ParameterError::none;
}

template <typename Scalar>
constexpr ParameterError check_homing(const HomingParameters<Scalar>& h) {
  using parameter_check::is_positive;
  if (h.mode == HomingMode::none) return ParameterError::none;
  const bool moves = is_positive(ScalarTraits<Scalar>::magnitude(h.velocity)) && is_positive(h.creep_velocity);
  return moves && h.travel > 0 && h.index_travel > 0 ? ParameterError::none : ParameterError::homing;
}

constexpr ParameterError check_sequence(const DriveSequenceParameters& s) {
  const bool is_sound = s.amplifier_wait >= 0 && s.brake_release >= 0 && s.brake_application >= 0;
  return is_sound && (!s.ready_input || s.amplifier_wait > 0) ? ParameterError::none : ParameterError::amplifier_ready;
}

/// Beyond these a monitor would not protect: what an axis at full command, from standstill, does in the times below, or
/// what a moving one needs if that is more.
namespace monitor_ceilings {

inline constexpr float kFollowing_s = 0.05f, kDisagreement_s = 0.05f, kJump_s = 0.1f, kOverspeed_s = 0.25f;
inline constexpr float kFollowingTime_s = 0.1f;  ///< of the velocity limit, and of any speed
inline constexpr float kSaturation_s = 1.0f;
inline constexpr float kCommandShare = 0.9f, kOscillationShare = 0.7f;  ///< of the converter's limit

/// Comparisons are multiplied by a sample's share of kLoadTime_s: so they stay within the range of fixed point.
template <typename Scalar>
struct Scaled {
  Scalar share, full_change, fastest, count;

  explicit constexpr Scaled(const AxisParameters<Scalar>& p)
      : share(p.monitors.load_share),
        full_change(p.drive.Bd2 * p.dac_limit_V),
        fastest(p.velocity_limit / p.lead),
        count(p.encoder_resolution / (p.lead * p.sample_period_s)) {}

  /// `speed` is at most what full command reaches in `time_s`, or `times` the velocity limit, or some `counts` a
  /// sample.
  constexpr bool is_speed_below(Scalar speed, float time_s, int times, int counts) const {
    return speed * share <= full_change * Scalar(time_s / kLoadTime_s) || speed <= fastest * Scalar(times) ||
           speed <= count * Scalar(counts);
  }
};

template <typename Scalar>
constexpr bool is_following_error_below(const AxisParameters<Scalar>& p, const Scaled<Scalar>& scaled) {
  const Scalar travel = p.lead * p.sample_period_s;
  constexpr float kTimes = kFollowing_s / kLoadTime_s;
  const Scalar by_full_command = scaled.full_change * travel * Scalar(0.5f * kTimes * kTimes) / scaled.share;
  const Scalar by_velocity = p.velocity_limit * p.sample_period_s * Scalar(kFollowingTime_s / kLoadTime_s);
  const Scalar floor = p.monitors.following_error_floor * scaled.share;
  return (floor <= by_full_command || floor <= by_velocity) &&
         p.monitors.following_error_per_velocity * scaled.share <= travel * Scalar(kFollowingTime_s / kLoadTime_s);
}

}  // namespace monitor_ceilings

/// Likewise for the monitors; every one of them must have a threshold, and none so high that it would not protect.
template <typename Scalar>
constexpr ParameterError check_monitors(const AxisParameters<Scalar>& p) {
  namespace ceiling = monitor_ceilings;
  using parameter_check::is_positive;
  using Traits = ScalarTraits<Scalar>;
  const MonitorLimits<Scalar>& m = p.monitors;
  const ceiling::Scaled<Scalar> scaled(p);
  const auto is_share = [](Scalar value) { return value >= Scalar(0) && Traits::is_finite(value); };
  if (!is_positive(m.following_error_floor) || !is_share(m.following_error_per_velocity) ||
      !ceiling::is_following_error_below(p, scaled))
    return ParameterError::following_error;
  if (!is_positive(m.disagreement_floor) || !is_share(m.disagreement_share) || m.disagreement_share > Scalar(1) ||
      !is_positive(m.encoder_jump) || !(m.encoder_jump > m.disagreement_floor) ||
      !scaled.is_speed_below(m.disagreement_floor, ceiling::kDisagreement_s, 1, 8) ||
      !scaled.is_speed_below(m.encoder_jump, ceiling::kJump_s, 2, 32))
    return ParameterError::disagreement;
  if (!is_positive(m.overspeed) || !(m.overspeed > scaled.fastest + scaled.count) ||
      !scaled.is_speed_below(m.overspeed, ceiling::kOverspeed_s, 3, 8))
    return ParameterError::overspeed;
  if (!is_positive(m.polarity_command_V) || m.polarity_command_V > p.dac_limit_V * Scalar(ceiling::kCommandShare))
    return ParameterError::polarity_command;
  if (!is_positive(m.oscillation_V) || m.oscillation_V > p.dac_limit_V * Scalar(ceiling::kOscillationShare))
    return ParameterError::oscillation;
  if (m.travel_min_counts >= m.travel_max_counts) return ParameterError::travel;
  if (m.index_spacing < 0) return ParameterError::index_spacing;
  if (m.saturation_samples <= 0 || m.capture_stride <= 0 || m.input_samples <= 0 ||
      Traits::times(m.saturation_samples, scaled.share) > Scalar(ceiling::kSaturation_s / kLoadTime_s))
    return ParameterError::saturation_time;
  return ParameterError::none;
}

}  // namespace firmware
