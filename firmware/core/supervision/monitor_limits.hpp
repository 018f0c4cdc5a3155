// Thresholds of the monitors in one table, and the weight of one sample in their filters.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "firmware/core/arithmetic/fixed_point.hpp"
#include "firmware/core/parameter_info.hpp"
#include "firmware/core/supervision/input_filter.hpp"

namespace firmware {

/// Units: mm (m), rad/s (m/s), V, samples, counts. Only the monitor of an optional part may be switched off
/// (check_monitors()).
template <typename Scalar>
struct MonitorLimits {
  Scalar following_error_floor{};         ///< following error that is allowed at standstill, > 0
  Scalar following_error_per_velocity{};  ///< its increase per rad/s (m/s) of reference velocity, mm s/rad (s)
  Scalar disagreement_floor{};            ///< difference of encoder and tachometer, allowed at standstill, > 0
  Scalar disagreement_share{};            ///< allowed difference as a share of the speed; 0..1
  Scalar encoder_jump{};                  ///< the same difference within one sample, > disagreement_floor
  Scalar overspeed{};                     ///< > 0
  Scalar polarity_command_V{};            ///< a command beyond any friction: it must accelerate the drive; > 0
  Scalar oscillation_V{};                 ///< allowed rms oscillation of the feedback, > 0
  std::int64_t travel_min_counts = 0;
  std::int64_t travel_max_counts = 0;   ///< > travel_min_counts
  std::int32_t index_spacing = 0;       ///< counts from one index pulse to the next; 0: not watched
  std::int32_t saturation_samples = 0;  ///< longest time at the D/A converter's limit, > 0
  Scalar load_share{};                  ///< of a sample in kLoadTime_s, 0..1
  Scalar swing_share{};                 ///< of a sample in kTransientTime_s, 0..1/2
  std::int32_t input_samples = 2;       ///< in which a switch or a fault line must be active, > 0
  std::int32_t capture_stride = 1;      ///< samples from one row of the capture to the next, > 0
};

/// Time constant of the filter over the difference of encoder and tachometer: 16 samples leave an eighteenth of the
/// tachometer's noise power, and a sixteenth of an encoder count a sample.
inline constexpr int kDisagreementShift = 4;
/// A command that lasts this long is needed for the load (effort_monitor.hpp).
inline constexpr float kLoadTime_s = 0.5f;
/// The oscillation of the feedback is its deviation from its mean over the first time, averaged over the second.
/// Reference ramps last longer than the first; friction's jump at a reversal is small within the second.
inline constexpr float kTransientTime_s = 0.008f, kSwingTime_s = 0.1f;
/// Samples for which the inputs are checked before an axis is ready; three time constants of the filter above.
inline constexpr std::int32_t kSelfTestSamples = 50;

/// Travel as encoder counts, limited to 32 bits.
constexpr std::int64_t whole_counts(float travel, float encoder_resolution) {
  constexpr float kMost = 2147483520.0F;  // the largest float below 2^31
  const float counts = travel / encoder_resolution;
  return static_cast<std::int32_t>(counts > kMost ? kMost : (counts < -kMost ? -kMost : counts));
}

/// Kind of threshold, which determines the units of the parameter and of its field.
enum class Quantity : std::uint8_t {
  length,               ///< mm (m)
  velocity,             ///< of the drive, rad/s (m/s)
  length_per_velocity,  ///< mm s/rad (s)
  command,              ///< V
  share,                ///< 1
  time,                 ///< s; kept in samples
  travel,               ///< mm (m); kept in counts
  counts,               ///< of the encoder
};

/// The parameter's row. Every threshold belongs to one axis and changes while the axis is disabled.
struct ThresholdRow {
  std::uint16_t id = 0;  ///< never used before (app/parameters/parameter_table.hpp)
  std::string_view name;
  Quantity quantity = Quantity::share;
  float minimum = 0, maximum = 0, initial = 0;
  std::string_view doc;

  constexpr ParameterInfo parameter() const {
    constexpr std::string_view kUnits[][2] = {{"mm", "m"}, {"rad/s", "m/s"}, {"mm/(rad/s)", "m/(m/s)"},
                                              {"V", "V"},  {"1", "1"},       {"s", "s"},
                                              {"mm", "m"}, {"", ""}};
    const auto& units = kUnits[static_cast<std::size_t>(quantity)];
    return {.id = id,
            .scope = ParameterScope::axis,
            .name = name,
            .type = quantity == Quantity::counts ? ParameterType::whole : ParameterType::real,
            .unit = units[0],
            .linear_unit = units[1],
            .minimum = minimum,
            .maximum = maximum,
            .initial = initial,
            .change = ParameterChange::while_disabled,
            .doc = doc};
  }
};

namespace threshold_table {

/// `Field`: pointer to the member of MonitorLimits that the parameter sets.
template <typename Field>
struct Threshold {
  Field field;
  ThresholdRow row;
};

template <typename Field>
constexpr Threshold<Field> threshold(Field field, const ThresholdRow& row) {
  return {field, row};
}

/// Initial values are those of the paper's x axis.
template <typename Scalar>
constexpr auto rows() {
  using M = MonitorLimits<Scalar>;
  using enum Quantity;
  return std::make_tuple(
      threshold(&M::following_error_floor,
                {144, "monitor.following_error", length, 1e-9F, 1e4F, 0.5F, "largest following error at standstill"}),
      threshold(&M::following_error_per_velocity, {145, "monitor.following_error_per_speed", length_per_velocity, 0,
                                                   1e3F, 0.005F, "increase of it per speed of the reference"}),
      threshold(&M::disagreement_floor, {146, "monitor.disagreement", velocity, 1e-9F, 1e4F, 10,
                                         "largest difference of encoder and tachometer at standstill"}),
      threshold(&M::disagreement_share,
                {147, "monitor.disagreement_share", share, 0, 1, 0.1F, "share of the speed added to it"}),
      threshold(&M::encoder_jump,
                {148, "monitor.encoder_jump", velocity, 1e-9F, 1e4F, 62.5F, "largest such difference in one sample"}),
      threshold(&M::overspeed, {149, "monitor.overspeed", velocity, 1e-9F, 1e4F, 300, "largest speed"}),
      threshold(&M::polarity_command_V, {150, "monitor.polarity_command", command, 1e-3F, 1e3F, 3,
                                         "command above any friction: it must accelerate the drive"}),
      threshold(&M::travel_min_counts,
                {151, "monitor.travel_min", travel, -1e6F, 1e6F, -1e5F, "end of travel of a homed axis"}),
      threshold(&M::travel_max_counts, {152, "monitor.travel_max", travel, -1e6F, 1e6F, 1e5F,
                                        "end of travel of a homed axis; before it is homed, it moves by at most max - "
                                        "min from where it was enabled"}),
      threshold(&M::saturation_samples,
                {153, "monitor.saturation_time", time, 1e-3F, 10, 0.1F, "longest time at the D/A converter's limit"}),
      threshold(&M::oscillation_V, {154, "monitor.oscillation", command, 1e-3F, 1e3F, 2.5F,
                                    "largest rms oscillation of the feedback's command without commanded motion"}),
      threshold(&M::index_spacing,
                {251, "encoder.index_spacing", counts, 0, 1e6F, 0,
                 "counts between two index pulses, which are then monitored; 0: no index is wired"}));
}

/// A parameter's value as its field stores it.
template <typename Kept>
constexpr Kept kept(float value, Quantity quantity, float encoder_resolution, float samples_a_second) {
  if constexpr (std::is_integral_v<Kept>) {
    if (quantity == Quantity::travel) return static_cast<Kept>(whole_counts(value, encoder_resolution));
    return quantity == Quantity::time ? ScalarTraits<float>::nearest_product(value, samples_a_second)
                                      : static_cast<Kept>(value);
  } else {
    return static_cast<Kept>(value);
  }
}

/// A field in fixed-point units (core/fixed_units.hpp); whole numbers are unchanged.
template <typename Kept, typename Units>
constexpr auto fixed(Kept value, Quantity quantity, const Units& unit) {
  if constexpr (std::is_integral_v<Kept>) {
    return value;
  } else {
    switch (quantity) {
      case Quantity::length:
        return FixedPoint::from(value / unit.length);
      case Quantity::velocity:
        return FixedPoint::from(value / unit.velocity);
      case Quantity::length_per_velocity:
        return FixedPoint::from(value * unit.velocity / unit.length);
      case Quantity::command:
        return FixedPoint::from(value / unit.volts);
      default:
        return FixedPoint::from(value);
    }
  }
}

}  // namespace threshold_table

template <typename Scalar>
inline constexpr auto kThresholds = threshold_table::rows<Scalar>();

/// Only the parameters' rows.
inline constexpr std::array kThresholdRows =
    std::apply([](const auto&... each) { return std::array{each.row...}; }, kThresholds<float>);

/// `visit`: a generic function that gets each threshold's place in the table, as a type.
template <typename Visit>
constexpr void for_each_threshold(Visit visit) {
  const auto visit_all = [&visit]<std::size_t... index>(std::index_sequence<index...>) {
    (visit(std::integral_constant<std::size_t, index>{}), ...);
  };
  visit_all(std::make_index_sequence<kThresholdRows.size()>());
}

/// Chosen so that the hundred intervals of a capture span at least 0.1 s.
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

/// From parameters: `value_of` is a generic function that gets a parameter's id as a type.
template <typename Real, typename ValueOf>
constexpr MonitorLimits<Real> monitor_limits(ValueOf value_of, float encoder_resolution, float sample_period_s) {
  MonitorLimits<Real> limits;
  const float samples_a_second = 1.0F / sample_period_s;
  for_each_threshold([&](auto index) {
    constexpr auto kThreshold = std::get<index()>(kThresholds<Real>);
    auto& kept = limits.*kThreshold.field;
    const float value = value_of(std::integral_constant<std::uint16_t, kThreshold.row.id>{});
    kept = threshold_table::kept<std::remove_reference_t<decltype(kept)>>(value, kThreshold.row.quantity,
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
  for_each_threshold([&](auto index) {
    constexpr auto kFrom = std::get<index()>(kThresholds<Real>);
    fixed.*std::get<index()>(kThresholds<FixedPoint>).field =
        threshold_table::fixed(limits.*kFrom.field, kFrom.row.quantity, unit);
  });
  fixed.load_share = FixedPoint::from(limits.load_share);
  fixed.swing_share = FixedPoint::from(limits.swing_share);
  fixed.input_samples = limits.input_samples;
  fixed.capture_stride = limits.capture_stride;
  return fixed;
}

}  // namespace firmware
