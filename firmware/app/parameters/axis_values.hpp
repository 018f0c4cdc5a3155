// Converts named values to the parameters of the control core.
#pragma once

#include "firmware/app/parameters/parameter_values.hpp"
#include "firmware/core/axis_parameters.hpp"
#include "firmware/core/fixed_units.hpp"

namespace firmware {

namespace axis_values {

/// To the nearest count.
constexpr std::int64_t nearest_counts(float travel, float encoder_resolution) {
  return whole_counts(travel + (travel < 0 ? -0.5F : 0.5F) * encoder_resolution, encoder_resolution);
}

constexpr HomingParameters<float> homing(const AxisValues& v) {
  const float encoder_resolution = v.get<"drive.encoder_resolution">();
  HomingParameters<float> h;
  h.mode = static_cast<HomingMode>(v.get<"homing.mode">());
  h.velocity = v.get<"homing.velocity">();
  h.creep_velocity = v.get<"homing.creep_velocity">();
  h.travel = whole_counts(v.get<"homing.travel">(), encoder_resolution);
  h.index_travel = whole_counts(v.get<"homing.index_travel">(), encoder_resolution);
  h.turn = v.get<"encoder.index_spacing">();
  h.position = nearest_counts(v.get<"homing.position">(), encoder_resolution);
  return h;
}

constexpr DriveSequenceParameters sequence(const AxisValues& v, float samples_a_second) {
  const auto samples = [=](float time_s) { return ScalarTraits<float>::nearest_product(time_s, samples_a_second); };
  return {.ready_input = v.get<"amplifier.ready_input">(),
          .brake_fitted = v.get<"brake.fitted">(),
          .amplifier_wait = samples(v.get<"amplifier.ready_time">()),
          .brake_release = samples(v.get<"brake.release_time">()),
          .brake_application = samples(v.get<"brake.apply_time">())};
}

/// Counts as an increment with whole and fraction; 0 if out of range.
constexpr Increment bounded_counts(float counts) {
  constexpr float kMost = 16384;  // 2^14
  return counts > 0 && counts <= kMost ? ScalarTraits<float>::to_increment(counts) : 0;
}

constexpr CompensationParameters<float> compensation(const AxisValues& v, float volts_per_effort) {
  const float encoder_resolution = v.get<"drive.encoder_resolution">();
  const auto harmonic = [&](float cosine, float sine, float period) {
    return TravelHarmonic<float>{
        .cosine = cosine, .sine = sine, .turns_per_count = bounded_counts(encoder_resolution / period)};
  };
  CompensationParameters<float> c;
  c.cogging_on = v.get<"cogging.on">();
  c.cogging_V = {harmonic(v.get<"cogging.cosine_1">() * volts_per_effort, v.get<"cogging.sine_1">() * volts_per_effort,
                          v.get<"cogging.period_1">()),
                 harmonic(v.get<"cogging.cosine_2">() * volts_per_effort, v.get<"cogging.sine_2">() * volts_per_effort,
                          v.get<"cogging.period_2">()),
                 harmonic(v.get<"cogging.cosine_3">() * volts_per_effort, v.get<"cogging.sine_3">() * volts_per_effort,
                          v.get<"cogging.period_3">())};
  c.position_friction_on = v.get<"position_friction.on">();
  c.position_friction = harmonic(v.get<"position_friction.cosine">(), v.get<"position_friction.sine">(),
                                 v.get<"position_friction.period">());
  c.presliding = {.on = v.get<"presliding.on">(),
                  .stiffness_V_per_rad = v.get<"presliding.stiffness">() * volts_per_effort,
                  .damping_V_s_per_rad = v.get<"presliding.damping">() * volts_per_effort};
  const float sample_period_s = v.get<"drive.sample_period">();
  const float samples_a_second = 1.0F / sample_period_s;
  c.backlash = {
      .on = v.get<"backlash.on">(),
      .gap = bounded_counts(v.get<"backlash.gap">() / encoder_resolution),
      .wind_up = bounded_counts(v.get<"backlash.wind_up">() / encoder_resolution),
      .crossing_samples = ScalarTraits<float>::nearest_product(v.get<"backlash.crossing_time">(), samples_a_second)};
  c.pitch = {
      .on = v.get<"pitch.on">(),
      .crossing_samples = ScalarTraits<float>::nearest_product(v.get<"pitch.crossing_time">(), samples_a_second)};
  return c;
}

/// Lambert's continued fraction; error below 1e-6 for x below 0.45 pi.
constexpr float tangent(float x) {
  float rest = 0.0F;
  for (float odd = 13.0F; odd > 0.5F; odd -= 2.0F) rest = x * x / (odd - rest);
  return rest / x;
}

/// `share`: frequency over control rate. If it is out of range, a1 is 0, which is invalid for a filter.
[[gnu::noinline]] constexpr BiquadParameters<float> biquad(bool on, float share, float damping) {
  BiquadParameters<float> f;
  f.on = on;
  if (!(share < 0.45F)) return f;
  const float g = tangent(3.14159265F * share);
  f.a1 = 1.0F / (1.0F + g * (g + 2.0F * damping));
  f.a2 = g * f.a1;
  f.a3 = g * f.a2;
  return f;
}

constexpr FilterParameters<float> filters(const AxisValues& v) {
  const float period_s = v.get<"drive.sample_period">();
  const float damping = v.get<"notch.damping">(), depth = v.get<"notch.depth">();
  FilterParameters<float> f = {
      biquad(v.get<"notch.on">(), v.get<"notch.frequency">() * period_s, damping),
      biquad(v.get<"low_pass.on">(), v.get<"low_pass.frequency">() * period_s, v.get<"low_pass.damping">())};
  f[0].of_band = 2.0F * damping * (depth - 1.0F);
  f[1].is_low_pass = true;
  return f;
}

constexpr AxisParameters<float> in_single_precision(const AxisValues& v) {
  const float effort_per_volt = v.get<"drive.effort_per_volt">();
  const float volts_per_effort = 1.0F / effort_per_volt;
  AxisParameters<float> p;
  p.sample_period_s = v.get<"drive.sample_period">();
  p.lead = v.get<"drive.lead">();
  p.encoder_resolution = v.get<"drive.encoder_resolution">();
  p.dac_resolution_V = v.get<"drive.dac_resolution">();
  p.dac_limit_V = v.get<"drive.dac_limit">();
  p.tachometer_fitted = v.get<"tachometer.fitted">();
  p.encoder_fault_input = v.get<"encoder.fault_input">();
  const float read_per_true = v.get<"calibration.tachometer_gain">();
  const float true_per_read = 1.0F / read_per_true;
  p.tachometer_gain = v.get<"tachometer.gain">() * true_per_read;
  const float offset = v.get<"tachometer.offset">(), offset_besides = v.get<"calibration.tachometer_offset">();
  p.tachometer_offset = (offset + offset_besides) * true_per_read;
  p.drive = {.Ad12 = v.get<"model.a12">(),
             .Ad22 = v.get<"model.a22">(),
             .Bd1 = v.get<"model.b1">(),
             .Bd2 = v.get<"model.b2">()};
  p.Kobs = {{{v.get<"kalman.k11">(), v.get<"kalman.k12">()},
             {v.get<"kalman.k21">(), v.get<"kalman.k22">()},
             {v.get<"kalman.k31">(), v.get<"kalman.k32">()}}};
  p.Kc = {v.get<"feedback.k1">(), v.get<"feedback.k2">()};
  p.friction.positive = {.static_V = v.get<"friction.static_positive">() * volts_per_effort,
                         .coulomb_V = v.get<"friction.coulomb_positive">() * volts_per_effort,
                         .viscous_V_s_per_rad = v.get<"friction.viscous_positive">() * volts_per_effort,
                         .omega1_rad_s = v.get<"friction.omega1_positive">(),
                         .omega2_rad_s = v.get<"friction.omega2_positive">()};
  p.friction.negative = {.static_V = v.get<"friction.static_negative">() * volts_per_effort,
                         .coulomb_V = v.get<"friction.coulomb_negative">() * volts_per_effort,
                         .viscous_V_s_per_rad = v.get<"friction.viscous_negative">() * volts_per_effort,
                         .omega1_rad_s = v.get<"friction.omega1_negative">(),
                         .omega2_rad_s = v.get<"friction.omega2_negative">()};
  p.friction.blend_velocity_rad_s = v.get<"friction.blend">();
  p.compensation = compensation(v, volts_per_effort);
  p.filters = filters(v);
  p.friction_feedforward_on = v.get<"feedforward.friction">();
  p.disturbance_cancellation_on = v.get<"feedback.cancel_disturbance">();
  p.zero_phase_feedforward_on = v.get<"feedforward.zero_phase">();
  p.velocity_limit = v.get<"limits.velocity">();
  p.acceleration_limit = v.get<"limits.acceleration">();
  p.jerk_limit = v.get<"limits.jerk">();
  p.fault_deceleration = v.get<"limits.fault_deceleration">();
  p.homing = homing(v);
  p.sequence = sequence(v, 1.0F / p.sample_period_s);
  p.monitors = monitor_limits<float>([&](auto id) { return v.with_id<decltype(id)::value>(); }, p.encoder_resolution,
                                     p.sample_period_s);
  return p;
}

}  // namespace axis_values

/// In the units of `Scalar`: mm (m), rad/s (m/s) and V in floating point, those of fixed_units.hpp in fixed point. The
/// values have passed check_value().
template <typename Scalar>
constexpr AxisParameters<Scalar> axis_parameters(const AxisValues& values) {
  if constexpr (std::is_same_v<Scalar, float>) {
    return axis_values::in_single_precision(values);
  } else {
    return to_fixed(axis_values::in_single_precision(values));
  }
}

}  // namespace firmware
