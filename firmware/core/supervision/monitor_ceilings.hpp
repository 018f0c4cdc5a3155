// Highest thresholds with which a monitor still protects: the motion of an axis at full command from standstill in the
// times below, or the value that a moving axis needs if that is larger.
#pragma once

#include "firmware/core/arithmetic/scalar.hpp"

namespace firmware {

template <typename Scalar>
struct AxisParameters;

/// A command that lasts this long is needed for the load (effort_monitor.hpp).
inline constexpr float kLoadTime_s = 0.5f;

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

}  // namespace monitor_ceilings

}  // namespace firmware
