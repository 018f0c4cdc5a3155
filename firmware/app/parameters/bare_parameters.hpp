// Parameters of an axis that has no design yet, for an excitation in open loop.
#pragma once

#include <algorithm>
#include <limits>

#include "firmware/app/parameters/axis_values.hpp"

namespace firmware {

namespace bare_parameters {

inline constexpr float kNever = 1e9F;  ///< a threshold that is never reached
inline constexpr float kLittle = 1e-4F;

/// `v`: values of an axis that is not fitted. `velocity_per_count`: rad/s (m/s) for one count a sample; `velocity`: the
/// largest velocity in the box. Both are 0 if the tachometer's scale is not known, and negative without a tachometer.
///
/// The estimate is the smoothed encoder reading (an alpha-beta filter with 1/2 and 1/10), for a model without effort.
/// The sensors are compared with each other if their scales are known. The limits of the box replace all other
/// monitors. The parameters of amplifier and brake apply as in a closed loop.
constexpr AxisParameters<float> in_single_precision(const AxisValues& v, float rate_Hz, float velocity_per_count,
                                                    float velocity) {
  AxisParameters<float> p;
  p.sample_period_s = 1.0F / rate_Hz;
  p.encoder_resolution = v.get<"drive.encoder_resolution">();
  p.lead = velocity_per_count > 0 ? p.encoder_resolution * rate_Hz / velocity_per_count : v.get<"drive.lead">();
  p.dac_resolution_V = v.get<"drive.dac_resolution">();
  p.dac_limit_V = v.get<"drive.dac_limit">();
  p.tachometer_fitted = v.get<"tachometer.fitted">() && !(velocity < 0);
  p.encoder_fault_input = v.get<"encoder.fault_input">();
  p.tachometer_gain = v.get<"tachometer.gain">();
  p.tachometer_offset = v.get<"tachometer.offset">();
  const FixedUnits<float> unit(p);
  p.drive = {.Ad12 = p.lead * p.sample_period_s,
             .Ad22 = 1.0F,
             .Bd1 = kLittle * unit.length / unit.volts,
             .Bd2 = kLittle * unit.velocity / unit.volts};
  p.Kobs = {{{0.5F, 0}, {0.1F / (p.lead * p.sample_period_s), 0}, {0, 0}}};
  MonitorLimits<float>& m = p.monitors;
  m = monitor_limits<float>([&](auto id) { return v.with_id<decltype(id)::value>(); }, p.encoder_resolution,
                            p.sample_period_s);
  const bool knows_scale = velocity_per_count > 0 && velocity > 0;
  m.disagreement_floor = knows_scale ? std::max(0.25F * velocity, 4 * velocity_per_count) : kNever;
  m.disagreement_share = 0.1F;
  m.encoder_jump = knows_scale ? std::max(velocity, 16 * velocity_per_count) : kNever;
  m.overspeed = m.following_error_floor = m.polarity_command_V = m.oscillation_V = kNever;
  m.travel_min_counts = -(std::int64_t{1} << 31);
  m.travel_max_counts = std::int64_t{1} << 31;
  m.saturation_samples = std::numeric_limits<std::int32_t>::max();
  m.capture_stride = capture_stride(rate_Hz);
  p.sequence = axis_values::sequence(v, rate_Hz);
  // References are constant; a stop that does not come to rest ends after about a second.
  const auto half_second = static_cast<Increment>(static_cast<std::int32_t>(rate_Hz) / 2);
  p.motion = {.velocity = kOneCount * 1000,
              .acceleration = kOneCount * 1000 / half_second,
              .jerk = kOneCount * 1000 / half_second};
  return p;
}

}  // namespace bare_parameters

template <typename Scalar>
constexpr AxisParameters<Scalar> bare_axis_parameters(const AxisValues& v, float rate_Hz, float velocity_per_count,
                                                      float velocity) {
  const AxisParameters<float> p = bare_parameters::in_single_precision(v, rate_Hz, velocity_per_count, velocity);
  if constexpr (std::is_same_v<Scalar, float>)
    return p;
  else
    return to_fixed(p);
}

}  // namespace firmware
