// Thresholds of the monitors, and the weight of one sample in their filters.
#pragma once

#include <cstdint>
#include <tuple>
#include <utility>

#include "firmware/core/supervision/input_filter.hpp"
#include "firmware/core/supervision/monitored_faults.hpp"

namespace firmware {

/// The members of every declaration's Limits, and these.
template <typename Scalar>
struct MonitorLimits : MonitoredFaults::Limits<Scalar> {
  Scalar load_share{};              ///< of a sample in kLoadTime_s, 0..1
  Scalar swing_share{};             ///< of a sample in kTransientTime_s, 0..1/2
  std::int32_t input_samples = 2;   ///< in which a switch or a fault line must be active, > 0
  std::int32_t capture_stride = 1;  ///< samples from one row of the capture to the next, > 0
};

/// Time constant of the filter over the difference of encoder and tachometer: 16 samples leave an eighteenth of the
/// tachometer's noise power, and a sixteenth of an encoder count a sample.
inline constexpr int kDisagreementShift = 4;
/// The swing of the feedback is what exceeds its mean over this time, and is averaged over the longer one. Reference
/// ramps last longer than the first; friction's jump at a reversal is small within the second.
inline constexpr float kTransientTime_s = 0.008f, kSwingTime_s = 0.1f;
/// Samples for which the inputs are checked before an axis is ready; three time constants of the filter above.
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

namespace monitored {

template <typename Declaration, typename Visit, std::size_t... index>
constexpr void visit_thresholds([[maybe_unused]] Visit visit, std::index_sequence<index...>) {
  (visit(Declaration{}, std::integral_constant<std::size_t, index>{}), ...);
}

}  // namespace monitored

/// `visit`: a generic function that gets each threshold, as its declaration and, as a type, its index in kThresholds.
template <typename Visit>
constexpr void for_each_threshold(Visit visit) {
  MonitoredFaults::for_each([&](auto declared) {
    using Declaration = decltype(declared);
    using Thresholds = std::remove_cvref_t<decltype(Declaration::template kThresholds<float>)>;
    monitored::visit_thresholds<Declaration>(visit, std::make_index_sequence<std::tuple_size_v<Thresholds>>());
  });
}

/// From parameters: `value_of` is a generic function that gets a parameter's id as a type.
template <typename Real, typename ValueOf>
constexpr MonitorLimits<Real> monitor_limits(ValueOf value_of, float encoder_resolution, float sample_period_s) {
  MonitorLimits<Real> limits;
  const float samples_a_second = 1.0F / sample_period_s;
  for_each_threshold([&](auto declared, auto index) {
    using Declaration = decltype(declared);
    constexpr auto kThreshold = std::get<index()>(Declaration::template kThresholds<Real>);
    auto& kept = limits.*kThreshold.field;
    const float value = value_of(std::integral_constant<std::uint16_t, kThreshold.row.id>{});
    kept = threshold_units::kept<std::remove_reference_t<decltype(kept)>>(value, kThreshold.row.quantity,
                                                                          encoder_resolution, samples_a_second);
  });
  set_filters(limits, static_cast<Real>(sample_period_s));
  limits.capture_stride = capture_stride(samples_a_second);
  return limits;
}

/// The same limits in fixed-point units (core/fixed_units.hpp).
template <typename Real, typename Units>
constexpr MonitorLimits<FixedPoint> fixed_limits(const MonitorLimits<Real>& limits, const Units& unit) {
  MonitorLimits<FixedPoint> fixed;
  for_each_threshold([&](auto declared, auto index) {
    using Declaration = decltype(declared);
    constexpr auto kFrom = std::get<index()>(Declaration::template kThresholds<Real>);
    constexpr auto kTo = std::get<index()>(Declaration::template kThresholds<FixedPoint>);
    fixed.*kTo.field = threshold_units::fixed(limits.*kFrom.field, kFrom.row.quantity, unit);
  });
  fixed.load_share = FixedPoint::from(limits.load_share);
  fixed.swing_share = FixedPoint::from(limits.swing_share);
  fixed.input_samples = limits.input_samples;
  fixed.capture_stride = limits.capture_stride;
  return fixed;
}

}  // namespace firmware
