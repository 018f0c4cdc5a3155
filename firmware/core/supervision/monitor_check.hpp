// Checks the monitors' thresholds. Each monitor still protects with the highest accepted threshold. This is the motion
// of an axis at full command from standstill in the times below, or the value that a moving axis needs if that is
// larger.
#pragma once

#include "firmware/core/axis_parameters.hpp"
#include "firmware/core/refusal.hpp"

namespace firmware {

namespace monitor_ceilings {

inline constexpr float kFollowing_s = 0.05f, kDisagreement_s = 0.05f, kJump_s = 0.1f, kOverspeed_s = 0.25f;
inline constexpr float kFollowingTime_s = 0.1f;  ///< of the velocity limit, and of any speed
inline constexpr float kSaturation_s = 1.0f;
inline constexpr float kCommandShare = 0.9f, kOscillationShare = 0.7f;  ///< of the converter's limit

/// Both sides of a comparison are multiplied by a sample's share of kLoadTime_s, to stay within the range of fixed
/// point.
template <typename Scalar>
struct Scaled {
  Scalar share, full_change, fastest, count;

  explicit constexpr Scaled(const AxisParameters<Scalar>& p)
      : share(p.monitors.load_share),
        full_change(p.drive.Bd2 * p.dac_limit_V),
        fastest(p.velocity_limit / p.lead),
        count(p.encoder_resolution / (p.lead * p.sample_period_s)) {}

  /// Whether `speed` is at most what full command reaches in `time_s`, or `times` the velocity limit, or some `counts`
  /// per sample.
  constexpr bool is_speed_below(Scalar speed, float time_s, int times, int counts) const {
    return speed * share <= full_change * Scalar(time_s / kLoadTime_s) || speed <= fastest * Scalar(times) ||
           speed <= count * Scalar(counts);
  }

  /// `samples` last at most `time_s`.
  constexpr bool is_time_below(std::int32_t samples, float time_s) const {
    return ScalarTraits<Scalar>::times(samples, share) <= Scalar(time_s / kLoadTime_s);
  }
};

template <typename Scalar>
constexpr bool is_share(Scalar value) {
  return value >= Scalar(0) && ScalarTraits<Scalar>::is_finite(value);
}

template <typename Scalar>
constexpr bool protects_following(const AxisParameters<Scalar>& p, const Scaled<Scalar>& scaled) {
  const Scalar travel = p.lead * p.sample_period_s;
  constexpr float kTimes = kFollowing_s / kLoadTime_s;
  const Scalar by_full_command = scaled.full_change * travel * Scalar(0.5f * kTimes * kTimes) / scaled.share;
  const Scalar by_velocity = p.velocity_limit * p.sample_period_s * Scalar(kFollowingTime_s / kLoadTime_s);
  const Scalar floor = p.monitors.following_error_floor, per_velocity = p.monitors.following_error_per_velocity;
  return is_positive(floor) && is_share(per_velocity) &&
         (floor * scaled.share <= by_full_command || floor * scaled.share <= by_velocity) &&
         per_velocity * scaled.share <= travel * Scalar(kFollowingTime_s / kLoadTime_s);
}

}  // namespace monitor_ceilings

/// The first threshold with which its monitor would not protect.
template <typename Scalar>
constexpr Refusal check_monitors(const AxisParameters<Scalar>& p) {
  using namespace monitor_ceilings;  // NOLINT(google-build-using-namespace): these are this function's
  const MonitorLimits<Scalar>& m = p.monitors;
  const Scaled<Scalar> scaled(p);
  if (!protects_following(p, scaled)) return Refusal::following_error;
  const bool protects_sensors = is_positive(m.disagreement_floor) && is_share(m.disagreement_share) &&
                                m.disagreement_share <= Scalar(1) && m.encoder_jump > m.disagreement_floor &&
                                scaled.is_speed_below(m.disagreement_floor, kDisagreement_s, 1, 8) &&
                                scaled.is_speed_below(m.encoder_jump, kJump_s, 2, 32);
  if (!protects_sensors) return Refusal::disagreement;
  if (!is_positive(m.overspeed) || !(m.overspeed > scaled.fastest + scaled.count) ||
      !scaled.is_speed_below(m.overspeed, kOverspeed_s, 3, 8))
    return Refusal::overspeed;
  const auto protects_command = [&p](Scalar volts, float most_share) {
    return is_positive(volts) && volts <= p.dac_limit_V * Scalar(most_share);
  };
  if (!protects_command(m.polarity_command_V, kCommandShare)) return Refusal::polarity_command;
  if (!protects_command(m.oscillation_V, kOscillationShare)) return Refusal::oscillation;
  if (m.travel_min_counts >= m.travel_max_counts) return Refusal::travel;
  if (m.index_spacing < 0) return Refusal::index_spacing;
  if (m.saturation_samples <= 0 || !scaled.is_time_below(m.saturation_samples, kSaturation_s))
    return Refusal::saturation_time;
  return m.capture_stride > 0 && m.input_samples > 0 ? Refusal::none : Refusal::sample_period;
}

}  // namespace firmware
