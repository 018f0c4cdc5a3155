// The units of fixed point: every state is of the order of one, whatever the machine.
#pragma once

#include "firmware/core/arithmetic/fixed_point.hpp"
#include "firmware/core/axis_check.hpp"

namespace firmware {

/// Length: one encoder count dx. Time: one sample Ts. So a velocity is in counts a sample, dx / (lead Ts) rad/s (m/s).
/// Voltage: 4096 steps of the converter, so that a step is exactly 2^-12.
///
/// Ranges, with a resolution of 4.8e-7 of each unit:
///   velocity            below 1024 counts a sample (2.5 m/s at 1 kHz and 2.44 um), and Kc2 times it below 1024 units
///   position error      saturates at 1024 counts; the converter saturates long before if Kc1 > 8 / 1024 units a count
///   any voltage         saturates at 1024 units (1280 V with steps of 0.3 mV); the converter's limit is 8
///   gains               Kobs, Kc, drive model in these units: below 1024
///   zero phase          its weights are exact to 1e-6 / (2 Bd1) relatively: use it where Bd1 is above 0.1 counts a
///                       unit
///   encoder, reference  unlimited: they are integers, 64 bits and more, as in float; so are the references' limits
///   parameters          rounded to 2.4e-7 of their unit: those of the order of 1 relatively to 2.4e-7, a tachometer's
///                       gain (some 0.01 counts a sample a code) to 3e-5
template <typename Real>
struct FixedUnits {
  Real length;  ///< mm (m)
  Real time_s;
  Real velocity;         ///< of the drive: rad/s (m/s)
  Real travel_velocity;  ///< mm/s (m/s)
  Real volts;

  /// Arguments as in AxisParameters.
  constexpr FixedUnits(Real sample_period_s, Real lead, Real encoder_resolution, Real dac_resolution_V)
      : length(encoder_resolution),
        time_s(sample_period_s),
        velocity(encoder_resolution / (lead * sample_period_s)),
        travel_velocity(encoder_resolution / sample_period_s),
        volts(Real(4096) * dac_resolution_V) {}
  explicit constexpr FixedUnits(const AxisParameters<Real>& p)
      : FixedUnits(p.sample_period_s, p.lead, p.encoder_resolution, p.dac_resolution_V) {}
};

/// The same axis in fixed-point units. A value that does not fit is set to the limit of the range, and
/// Axis::configure() refuses it as not finite. Telemetry is in these units too.
template <typename Real>
constexpr AxisParameters<FixedPoint> to_fixed(const AxisParameters<Real>& p) {
  const FixedUnits<Real> unit(p);
  const auto fixed = [](Real value) { return FixedPoint::from(value); };
  const Real gain_velocity = unit.velocity / unit.volts;
  const auto direction = [&](const FrictionDirection<Real>& d) {
    return FrictionDirection<FixedPoint>{.static_V = fixed(d.static_V / unit.volts),
                                         .coulomb_V = fixed(d.coulomb_V / unit.volts),
                                         .viscous_V_s_per_rad = fixed(d.viscous_V_s_per_rad * gain_velocity),
                                         .omega1_rad_s = fixed(d.omega1_rad_s / unit.velocity),
                                         .omega2_rad_s = fixed(d.omega2_rad_s / unit.velocity)};
  };
  AxisParameters<FixedPoint> q;
  q.sample_period_s = q.lead = q.encoder_resolution = FixedPoint(1);
  q.dac_resolution_V = fixed(p.dac_resolution_V / unit.volts);
  q.dac_limit_V = fixed(p.dac_limit_V / unit.volts);
  q.tachometer_fitted = p.tachometer_fitted;
  q.encoder_fault_input = p.encoder_fault_input;
  q.tachometer_gain = fixed(p.tachometer_gain / unit.velocity);
  q.tachometer_offset = fixed(p.tachometer_offset / unit.velocity);
  q.drive = {.Ad12 = fixed(p.drive.Ad12 * unit.velocity / unit.length),
             .Ad22 = fixed(p.drive.Ad22),
             .Bd1 = fixed(p.drive.Bd1 * unit.volts / unit.length),
             .Bd2 = fixed(p.drive.Bd2 * unit.volts / unit.velocity)};
  const Real row_unit[3] = {unit.length, unit.velocity, unit.volts};
  for (std::size_t row = 0; row < 3; ++row)
    q.Kobs[row] = {fixed(p.Kobs[row][0] * unit.length / row_unit[row]),
                   fixed(p.Kobs[row][1] * unit.velocity / row_unit[row])};
  q.Kc = {fixed(p.Kc[0] * unit.length / unit.volts), fixed(p.Kc[1] * gain_velocity)};
  q.friction = {.positive = direction(p.friction.positive),
                .negative = direction(p.friction.negative),
                .blend_velocity_rad_s = fixed(p.friction.blend_velocity_rad_s / unit.velocity)};
  const CompensationParameters<Real>& c = p.compensation;
  const auto harmonic = [&](const TravelHarmonic<Real>& h, Real unit_of_value) {
    return TravelHarmonic<FixedPoint>{.cosine = fixed(h.cosine / unit_of_value),
                                      .sine = fixed(h.sine / unit_of_value),
                                      .turns_per_count = h.turns_per_count};
  };
  q.compensation.cogging_on = c.cogging_on;
  for (std::size_t i = 0; i < c.cogging_V.size(); ++i)
    q.compensation.cogging_V[i] = harmonic(c.cogging_V[i], unit.volts);
  q.compensation.position_friction_on = c.position_friction_on;
  q.compensation.position_friction = harmonic(c.position_friction, Real(1));
  q.compensation.presliding = {
      .on = c.presliding.on,
      .stiffness_V_per_rad = fixed(c.presliding.stiffness_V_per_rad * gain_velocity * unit.time_s),
      .damping_V_s_per_rad = fixed(c.presliding.damping_V_s_per_rad * gain_velocity)};
  q.compensation.backlash = c.backlash;
  q.compensation.pitch = c.pitch;
  for (std::size_t i = 0; i < kControlFilters; ++i) {
    const BiquadParameters<Real>& f = p.filters[i];
    q.filters[i] = {.on = f.on,
                    .is_low_pass = f.is_low_pass,
                    .a1 = fixed(f.a1),
                    .a2 = fixed(f.a2),
                    .a3 = fixed(f.a3),
                    .of_band = fixed(f.of_band)};
  }
  q.friction_feedforward_on = p.friction_feedforward_on;
  q.disturbance_cancellation_on = p.disturbance_cancellation_on;
  q.zero_phase_feedforward_on = p.zero_phase_feedforward_on;
  q.homing = {.mode = p.homing.mode,
              .velocity = fixed(p.homing.velocity / unit.travel_velocity),
              .creep_velocity = fixed(p.homing.creep_velocity / unit.travel_velocity),
              .travel = p.homing.travel,
              .index_travel = p.homing.index_travel,
              .position = p.homing.position,
              .turn = p.homing.turn};
  q.sequence = p.sequence;
  q.monitors = fixed_limits(p.monitors, unit);
  q.velocity_limit = fixed(p.velocity_limit / unit.travel_velocity);
  q.acceleration_limit = fixed(p.acceleration_limit / unit.travel_velocity * unit.time_s);
  q.fault_deceleration = fixed(p.fault_deceleration / unit.travel_velocity * unit.time_s);
  q.jerk_limit = fixed(p.jerk_limit / unit.travel_velocity * unit.time_s * unit.time_s);
  q.motion = motion_limits(p);
  return q;
}

}  // namespace firmware
