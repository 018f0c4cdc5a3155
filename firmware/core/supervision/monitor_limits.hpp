// The thresholds of the monitors. Every monitor is on: there is no value that switches one off.
#pragma once

#include <cstdint>

#include "firmware/core/arithmetic/scalar.hpp"
#include "firmware/core/supervision/input_filter.hpp"

namespace firmware {

/// Lengths in mm (m), velocities of the drive in rad/s (m/s), times in samples.
template <typename Scalar>
struct MonitorLimits {
  Scalar following_error_floor{};         ///< following error that is allowed at standstill, > 0
  Scalar following_error_per_velocity{};  ///< what each rad/s (m/s) of reference velocity adds to it, mm s/rad (s)
  Scalar disagreement_floor{};            ///< difference of encoder and tachometer, allowed at standstill, > 0
  Scalar disagreement_share{};            ///< what it may grow to, as a share of the speed; 0..1
  Scalar encoder_jump{};                  ///< the same difference within one sample, > disagreement_floor
  Scalar overspeed{};                     ///< > 0
  Scalar polarity_command_V{};            ///< a command beyond any friction: it must accelerate the drive; > 0
  Scalar oscillation_V{};                 ///< rms that the feedback may swing by, > 0
  Scalar load_share{};                    ///< of a sample in kLoadTime_s, 0..1
  Scalar swing_share{};                   ///< of a sample in kTransientTime_s, 0..1/2
  std::int64_t travel_min_counts = 0;     ///< encoder counts
  std::int64_t travel_max_counts = 0;     ///< > travel_min_counts
  std::int32_t index_spacing = 0;         ///< counts from one index pulse to the next; 0: not watched
  std::int32_t saturation_samples = 0;    ///< longest time at the D/A converter's limit, > 0
  std::int32_t input_samples = 2;         ///< that a switch or a fault line must be active in, > 0
  std::int32_t capture_stride = 1;        ///< samples from one row of the capture to the next, > 0
};

/// Time constant of the filter over the difference of encoder and tachometer: 16 samples leave an eighteenth of the
/// tachometer's noise power, and a sixteenth of an encoder count a sample.
inline constexpr int kDisagreementShift = 4;
/// A command that lasts as long is what the load needs (effort_monitor.hpp).
inline constexpr float kLoadTime_s = 0.5f;
/// The feedback's swing is what is left without the mean of this time, and is averaged over the longer one: ramps of
/// references last longer than the first, and friction's jump at a reversal is small within the second.
inline constexpr float kTransientTime_s = 0.008f, kSwingTime_s = 0.1f;
/// Samples that the inputs are watched before an axis is ready; three time constants of the filter above.
inline constexpr std::int32_t kSelfTestSamples = 50;

/// So that the hundred intervals of a capture span at least 0.1 s.
template <typename Real>
constexpr std::int32_t capture_stride(Real samples_a_second) {
  return (ScalarTraits<Real>::truncate(samples_a_second * Real(0.1f) + Real(0.5f)) - 1) / 100 + 1;
}

/// The filters of monitors and inputs, for a sample period.
template <typename Real>
constexpr void set_filters(MonitorLimits<Real>& limits, Real sample_period_s) {
  limits.load_share = sample_period_s / Real(kLoadTime_s);
  limits.input_samples = input_samples(sample_period_s);
  limits.swing_share = sample_period_s / Real(kTransientTime_s);
  if (limits.swing_share > Real(0.5f)) limits.swing_share = Real(0.5f);
}

/// Where nothing better is known. Following error: the way of 2 ms at the velocity limit, and 5 ms of the present
/// speed; state feedback without any feed-forward is some 1 ms late. Disagreement: 4 % of the velocity limit and 10 %
/// of the speed (tachometers are within 2 %, ripple included); a jump: a quarter of the limit; neither below what the
/// encoder's steps look like. Overspeed: a fifth above the limit. Polarity: 30 % of the converter, well above any
/// friction that can still be overcome. Oscillation: 25 % of the converter. Saturation: 0.1 s. Travel: all that an
/// encoder counter holds. `velocity_limit` mm/s (m/s), `lead` mm/rad (1).
template <typename Real>
constexpr MonitorLimits<Real> default_monitor_limits(Real velocity_limit, Real lead, Real encoder_resolution,
                                                     Real sample_period_s, Real dac_limit_V) {
  const Real fastest = velocity_limit / lead;
  const Real count = encoder_resolution / (lead * sample_period_s);
  const auto larger = [](Real a, Real b) { return a > b ? a : b; };
  MonitorLimits<Real> limits;
  limits.following_error_floor = velocity_limit * Real(0.002f);
  limits.following_error_per_velocity = lead * Real(0.005f);
  limits.disagreement_floor = larger(fastest * Real(0.04f), count * Real(2));
  limits.disagreement_share = Real(0.1f);
  limits.encoder_jump = larger(fastest * Real(0.25f), count * Real(8));
  limits.overspeed = larger(fastest * Real(1.2f), fastest + count * Real(2));
  limits.polarity_command_V = dac_limit_V * Real(0.3f);
  limits.oscillation_V = dac_limit_V * Real(0.25f);
  set_filters(limits, sample_period_s);
  limits.travel_min_counts = -(std::int64_t{1} << 31);
  limits.travel_max_counts = std::int64_t{1} << 31;
  const std::int32_t samples = ScalarTraits<Real>::truncate(Real(0.1f) / sample_period_s + Real(0.5f));
  limits.saturation_samples = samples;
  limits.capture_stride = capture_stride(Real(1) / sample_period_s);
  return limits;
}

}  // namespace firmware
