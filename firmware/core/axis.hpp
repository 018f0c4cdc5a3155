// The control law of one axis: measure, estimate, take the reference, control, output.
#pragma once

#include <cstdint>

#include "firmware/core/axis_check.hpp"
#include "firmware/core/axis_parameters.hpp"
#include "firmware/core/axis_telemetry.hpp"
#include "firmware/core/compensation/drive_compensation.hpp"
#include "firmware/core/control/control_filter.hpp"
#include "firmware/core/control/dac_conversion.hpp"
#include "firmware/core/control/friction_feedforward.hpp"
#include "firmware/core/control/kalman_estimator.hpp"
#include "firmware/core/motion/reference_generator.hpp"
#include "firmware/core/motion/reference_preview.hpp"
#include "firmware/core/motion/stopping_distance.hpp"
#include "hal/axis_hal.hpp"

namespace firmware {

/// step() runs once a sample period, in the control interrupt; everything else is called between steps. Nothing here
/// allocates, waits or throws, and a step's work has a constant bound.
///
///   u(k) = Kc1 (xref(k) - x_hat(k)) - Kc2 w_hat(k) + feed-forward of wref(k ..)     (50), or with zero phase error
///        + friction(wref(k+1))                                                     if switched on, (19)
///        + compensation (folder compensation/)                                     if switched on
///        + d_hat(k)                                                                if switched on
///
/// Notch and low-pass (control_filter.hpp), each if switched on, filter everything except friction.
///
/// The estimator gets the converter's actual output minus the friction feed-forward. d_hat is therefore the disturbance
/// that feed-forward does not cover, and cancelling it does not count friction twice. Friction uses wref(k+1), the
/// velocity of the interval in which u(k) is held.
template <typename Scalar, hal::AxisHal Hal>
class Axis {
 public:
  explicit constexpr Axis(Hal& hal) : hal_(hal) {}

  /// Takes new parameters; if they are wrong, returns why and keeps the old ones. Only while disabled.
  constexpr Refusal configure(const AxisParameters<Scalar>& parameters) {
    if (telemetry_.enabled) return Refusal::controller_is_enabled;
    const Refusal error = check(parameters);
    if (error != Refusal::none) return error;
    parameters_ = parameters;
    limits_ = motion_limits(parameters);
    const Scalar travel_per_velocity = parameters.lead * parameters.sample_period_s;
    counts_per_sample_per_velocity_ = parameters.sample_period_s / parameters.encoder_resolution;
    estimator_.configure(parameters.drive, parameters.Kobs, parameters.encoder_resolution);
    preview_.configure(parameters.encoder_resolution / travel_per_velocity);
    feedforward_ = parameters.zero_phase_feedforward_on
                       ? zero_phase_feedforward(parameters.drive, parameters.Kc, travel_per_velocity)
                       : backward_difference_feedforward(parameters.Kc);
    if (parameters.friction_feedforward_on) friction_.configure(parameters.friction);
    compensation_.configure(parameters.compensation, parameters.friction_feedforward_on, parameters.friction,
                            parameters.sample_period_s);
    backlash_.configure(parameters.compensation.backlash);
    pitch_.configure(parameters.compensation.pitch);
    filters_.configure(parameters.filters);
    generator_.configure(limits_);
    stopping_.configure(limits_);
    const auto longest_run_out = static_cast<std::int32_t>(limits_.acceleration / limits_.jerk) + 1 + kPreviewSamples;
    farthest_stop_ = stopping_.counts(limits_.velocity, longest_run_out);
    dac_.configure(parameters.dac_resolution_V, parameters.dac_limit_V);
    is_configured_ = true;
    is_synchronised_ = false;
    return Refusal::none;
  }

  /// Closes the loop from the next step on, with the reference at the axis's position. Returns false while a fault is
  /// latched (telemetry().fault) or before parameters have been accepted.
  constexpr bool enable() {
    if (!is_configured_) telemetry_.fault = AxisFault::parameters_missing;
    if (telemetry_.fault != AxisFault::none) return false;
    if (!telemetry_.enabled) {
      telemetry_.enabled = true;
      generator_.reset();  // with the usual deceleration
      is_closed_loop_ = !is_open_loop_;
      is_plain_loop_ = is_closed_loop_ && !pitch_.is_on();
      pitch_.enter(table_of_motor(), telemetry_.homed);
      energise();
    }
    return true;
  }

  /// Sets only the enable line, for an amplifier that needs time: the loop stays open, at 0 V.
  constexpr void energise() { hal_.drive_enable().set(true); }

  /// Opens the loop at once: 0 V, enable line off.
  constexpr void disable() {
    telemetry_.enabled = false;
    pitch_.leave();
    forget_excitation();
    hal_.drive_enable().set(false);
    put_out_zero();
  }

  /// Added to the control signal of every step from now on, V; in an open loop it is the whole command.
  constexpr void excite(Scalar volts) { excitation_V_ = volts; }
  /// From the next enable() until the axis is disabled, the command is the value of excite(), and the reference stays
  /// at the axis's position. Only while disabled.
  constexpr void open_loop() { is_open_loop_ = true; }
  constexpr void forget_excitation() {
    is_open_loop_ = is_closed_loop_ = is_plain_loop_ = false;
    excitation_V_ = Scalar(0);
  }
  constexpr bool is_open_loop() const { return is_open_loop_; }

  /// The table that pitch.on subtracts from the reference. Call it before configure(), while disabled; the table must
  /// stay in place.
  constexpr void use_pitch_table(PitchTable table) { pitch_.use(table); }
  /// Largest offset of the reference from the wanted position of the table, counts.
  constexpr std::int64_t largest_offset() const { return backlash_.largest_offset() + pitch_.largest_offset(); }

  /// From now on a failed sensor does not open the loop: the caller of the step sees telemetry().fault and decides.
  constexpr void leave_sensors_to_supervisor() { decides_on_sensors_ = false; }

  /// One control period without estimate and reference: outputs `volts` and reads the sensors that work; `velocity`
  /// replaces the estimate's.
  [[gnu::noinline]] constexpr void step_with_command(const hal::EncoderReading& encoder, Scalar volts,
                                                     Scalar velocity) {
    telemetry_.encoder_travel = encoder.valid ? counter_.advance(encoder.counts) : 0;
    telemetry_.encoder_counts = counter_.counts();
    telemetry_.estimate = estimator_.at_rest(counter_.counts());
    telemetry_.estimate.velocity = velocity;
    if (parameters_.tachometer_fitted) {
      const hal::TachometerReading tachometer = hal_.tachometer().read();
      if (tachometer.valid) telemetry_.tachometer_velocity = velocity_of(tachometer);
    }
    hold_reference_here();
    excitation_V_ = volts;
    put_out_excitation();
  }

  constexpr void clear_fault() {
    telemetry_.fault = AxisFault::none;
    is_synchronised_ = false;
  }

  /// From now on positions count from home: the former 0 is `origin`. The axis does not move.
  constexpr void set_home(std::int64_t origin) {
    counter_.shift(origin);
    telemetry_.encoder_counts += origin;
    telemetry_.estimate.anchor_counts += origin;
    telemetry_.reference.counts += origin;
    preview_.shift(origin);
    if (is_closed_loop_ && pitch_.is_on()) pitch_.shift(origin);
    telemetry_.homed = true;
  }
  /// The position is unknown from now on; only changes of it are known.
  constexpr void forget_home() { telemetry_.homed = false; }

  /// Encoder counter of the last step.
  constexpr std::uint32_t encoder_reading() const { return counter_.last_reading(); }
  /// Call it before a step that is late: the travel of the lost periods does not count as an error. The reference moves
  /// along, so that a stop begins at the axis's position and speed.
  constexpr void bridge_gap(const hal::EncoderReading& encoder) {
    if (!telemetry_.enabled || !encoder.valid || !is_synchronised_) return;
    const std::int64_t missed = counter_.counts_at(encoder.counts) - counter_.counts() - telemetry_.encoder_travel;
    counter_.skip(static_cast<std::int32_t>(missed));
    telemetry_.estimate.anchor_counts += missed;
    preview_.shift(missed);
    if (is_closed_loop_ && pitch_.is_on()) pitch_.shift(missed);
  }

  /// Position of an encoder reading in this axis's counts.
  constexpr std::int64_t counts_at(std::uint32_t reading) const { return counter_.counts_at(reading); }
  /// The same without the present offsets of backlash and pitch compensation: where the table was.
  constexpr std::int64_t table_counts_at(std::uint32_t reading) const {
    CountPosition table = CountPosition::at(counts_at(reading));
    table.advance(kOneCount / 2 - backlash_.offset(0) - pitch_.offset(0));
    return table.counts;
  }

  /// Velocity reference, mm/s (m/s), limited to the velocity limit; 0 slows down to standstill. False while disabled.
  constexpr bool jog(Scalar velocity) {
    if (!telemetry_.enabled || ScalarTraits<Scalar>::is_nan(velocity)) return false;
    const Scalar limit = parameters_.velocity_limit;
    if (velocity > limit) velocity = limit;
    if (velocity < Scalar(0) - limit) velocity = Scalar(0) - limit;
    generator_.jog(ScalarTraits<Scalar>::to_increment(velocity * counts_per_sample_per_velocity_));
    return true;
  }

  /// Stops a jog in time, so that it ends within these counts; call it before each step(). Moves are planned to end
  /// inside.
  constexpr void keep_inside(std::int64_t min_counts, std::int64_t max_counts) {
    if (generator_.mode() != MotionMode::jog) return;
    const Increment velocity = generator_.jog_profile().run_out_velocity();
    if (velocity == 0) return;
    const std::int64_t here = preview_.position().counts;
    const std::int64_t room = velocity > 0 ? max_counts - here : here - min_counts;
    const std::int32_t delay = generator_.jog_profile().run_out_samples() + kPreviewSamples;
    if (room <= stopping_.counts(velocity, delay)) generator_.jog(0);
  }

  /// Stopping distance from the velocity limit, counts: if no end of travel is closer, keep_inside() does nothing.
  constexpr std::int64_t farthest_stop() const { return farthest_stop_; }

  /// Slows down to standstill within the limits.
  constexpr void stop() { generator_.stop(); }

  /// All further stops, until the loop opens, use the fault deceleration.
  constexpr void brake_hard() { generator_.brake_hard(); }

  /// Like stop(), after step_with(): the stop begins at the speed of the whole reference.
  constexpr void stop_interpolated() { generator_.stop_from(preview_.newest()); }

  /// Where the table's reference will be kPreviewSamples from now; the next command to the axis starts from there.
  constexpr CountPosition leading() const {
    CountPosition leading = preview_.leading();
    leading.advance(-backlash_.offset(kPreviewSamples) - pitch_.offset(kPreviewSamples));
    return leading;
  }

  /// Plans a move from the present reference. Divides: for the background, not for the control interrupt.
  constexpr MovePlanResult plan_move_to(const CountPosition& target) const {
    // The difference of positions needs 64 bits; no reference is that far away.
    constexpr std::int64_t kFarthestTarget = std::int64_t{1} << 62;
    if (target.counts > kFarthestTarget || target.counts < -kFarthestTarget) return {{}, Refusal::move_too_long};
    return plan_move(target - leading(), limits_);
  }

  /// The same for a move by this many counts.
  constexpr MovePlanResult plan_move_by(std::int64_t counts, std::int32_t share_of_velocity = kWholeVelocity) const {
    MotionLimits limits = limits_;
    if (share_of_velocity < kWholeVelocity) limits.velocity = limits.velocity / kWholeVelocity * share_of_velocity;
    if (limits.velocity < kLeastMotion) limits.velocity = kLeastMotion;
    return plan_move(CountPosition::at(counts), limits);
  }

  /// Starts a plan made while the reference was at rest; it must still be at rest. Returns false otherwise, or while
  /// disabled.
  constexpr bool start(const MovePlan& plan) { return telemetry_.enabled && generator_.start(plan); }

  /// The reference, including its preview, is at rest.
  constexpr bool is_at_rest() const {
    return generator_.at_rest() && preview_.position() == preview_.leading() && !backlash_.is_crossing() &&
           !pitch_.is_crossing();
  }

  /// One control period with the axis's own reference. The caller gives the encoder reading if several axes are read at
  /// one instant.
  constexpr const AxisTelemetry<Scalar>& step(const hal::EncoderReading& encoder) {
    return follow(encoder, telemetry_.enabled ? generator_.next() : 0);
  }
  constexpr const AxisTelemetry<Scalar>& step() { return step(hal_.encoder().read()); }

  /// The same plus an increment for kPreviewSamples from now, from an interpolator that coordinates several axes;
  /// |increment| < 2^61.
  constexpr const AxisTelemetry<Scalar>& step_with(Increment increment, const hal::EncoderReading& encoder) {
    return follow(encoder, telemetry_.enabled ? increment + generator_.next() : 0);
  }
  constexpr const AxisTelemetry<Scalar>& step_with(Increment increment) {
    return step_with(increment, hal_.encoder().read());
  }

  constexpr const AxisTelemetry<Scalar>& telemetry() const { return telemetry_; }
  constexpr const AxisParameters<Scalar>& parameters() const { return parameters_; }

  /// Visits what only configure() changes, for a check of the memory.
  template <typename Visit>
  constexpr void each_setting(Visit visit) const {
    visit(parameters_);
    visit(limits_);
    visit(counts_per_sample_per_velocity_);
    visit(estimator_);
    visit(feedforward_);
    visit(stopping_);
    visit(dac_);
    visit(friction_);
  }

  /// Travel of the whole reference in the newest sample, kPreviewSamples ahead.
  constexpr Increment newest_increment() const { return preview_.newest(); }

  /// The reference without the offsets of backlash and pitch compensation: the wanted position of the table.
  constexpr CountPosition table_reference() const {
    CountPosition table = table_of_motor();
    table.advance(-pitch_.offset(0));
    return table;
  }

 private:
  using Traits = ScalarTraits<Scalar>;

  constexpr CountPosition table_of_motor() const {
    CountPosition table = preview_.position();
    table.advance(-backlash_.offset(0));
    return table;
  }

  [[gnu::noinline]] constexpr const AxisTelemetry<Scalar>& follow(const hal::EncoderReading& encoder,
                                                                  Increment increment) {
    if (!measure(encoder)) return telemetry_;
    if (!is_plain_loop_) {
      if (!is_closed_loop_) return follow_nothing();
      increment += pitch_.next(increment, telemetry_.homed);
    }
    preview_.push(backlash_.is_on() ? increment + backlash_.next(increment) : increment);
    control();
    return telemetry_;
  }

  [[gnu::noinline]] constexpr const AxisTelemetry<Scalar>& follow_nothing() {
    hold_reference_here();
    if (telemetry_.enabled)
      put_out_excitation();
    else
      put_out_zero();
    return telemetry_;
  }

  constexpr bool measure(const hal::EncoderReading& encoder) {
    if (!is_synchronised_ && !is_configured_) return false;
    if (!encoder.valid) return lose(AxisFault::encoder_invalid);
    if (!is_synchronised_) synchronise(encoder);
    telemetry_.encoder_travel = counter_.advance(encoder.counts);
    telemetry_.encoder_counts = counter_.counts();
    if (parameters_.tachometer_fitted) {
      const hal::TachometerReading tachometer = hal_.tachometer().read();
      if (!tachometer.valid) return lose(AxisFault::tachometer_invalid);
      telemetry_.tachometer_velocity = velocity_of(tachometer);
      estimator_.update(telemetry_.estimate, model_input_V_, telemetry_.encoder_counts, telemetry_.tachometer_velocity);
    } else {
      estimator_.update(telemetry_.estimate, model_input_V_, telemetry_.encoder_counts);
    }
    return true;
  }

  [[gnu::noinline]] constexpr void synchronise(const hal::EncoderReading& encoder) {
    telemetry_.estimate = estimator_.at_rest(counter_.extend(encoder.counts));
    preview_.reset(CountPosition::at(counter_.counts()));
    model_input_V_ = Scalar(0);
    backlash_.reset();
    pitch_.reset();
    is_synchronised_ = true;
  }

  constexpr void control() {
    const AxisEstimate<Scalar>& estimate = telemetry_.estimate;
    telemetry_.reference = preview_.position();
    telemetry_.reference_velocity = preview_.velocity(0);
    telemetry_.tracking_error =
        counts_near<Scalar>(estimate.anchor_counts, preview_.position()) * parameters_.encoder_resolution;
    telemetry_.position_error = telemetry_.tracking_error - estimate.offset;
    if (compensation_.is_on())
      telemetry_.friction_V =
          compensation_.advance(friction_, backlash_, preview_.velocity(1), preview_.halfway(), telemetry_.homed);
    else
      telemetry_.friction_V = parameters_.friction_feedforward_on ? friction_(preview_.velocity(1)) : Scalar(0);
    const Scalar added_V = preview_.weighted_sum(feedforward_) + excitation_V_;
    Scalar control_V = parameters_.Kc[0] * telemetry_.position_error - parameters_.Kc[1] * estimate.velocity + added_V +
                       telemetry_.friction_V;
    if (parameters_.disturbance_cancellation_on) control_V = control_V + estimate.disturbance;
    if (filters_.is_on()) {
      const Scalar beside = excitation_V_ + telemetry_.friction_V;
      control_V = filters_.next(control_V - beside) + beside;
    }
    telemetry_.control_V = control_V;
    if (!dac_.is_within(control_V) && Traits::is_nan(control_V)) {
      latch(Traits::is_nan(estimate.offset + estimate.velocity + estimate.disturbance)
                ? AxisFault::state_not_a_number
                : AxisFault::control_signal_not_a_number);
      return;
    }
    const DacWord<Scalar> word = dac_(control_V);
    telemetry_.dac_code = word.code;
    telemetry_.saturated = word.saturated;
    telemetry_.output_V = word.volts;
    model_input_V_ = word.volts - telemetry_.friction_V;
    telemetry_.feedback_V = model_input_V_ - added_V + parameters_.Kc[1] * telemetry_.reference_velocity;
    if (!hal_.dac().write(word.code)) latch(AxisFault::dac_write_failed);
  }

  constexpr void hold_reference_here() {
    generator_.reset();
    compensation_.reset();
    filters_.reset();
    preview_.reset(CountPosition::at(telemetry_.encoder_counts));
    telemetry_.reference = preview_.position();
    telemetry_.reference_velocity = Scalar(0);
    telemetry_.tracking_error = Scalar(0);
    telemetry_.position_error = Scalar(0) - telemetry_.estimate.offset;
  }

  constexpr void put_out_zero() {
    telemetry_.control_V = telemetry_.friction_V = telemetry_.output_V = telemetry_.feedback_V = Scalar(0);
    model_input_V_ = Scalar(0);
    telemetry_.dac_code = 0;
    telemetry_.saturated = false;
    if (!hal_.dac().write(0) && telemetry_.fault == AxisFault::none) telemetry_.fault = AxisFault::dac_write_failed;
  }

  constexpr void put_out_excitation() {
    const DacWord<Scalar> word = dac_(excitation_V_);
    telemetry_.control_V = excitation_V_;
    telemetry_.dac_code = word.code;
    telemetry_.saturated = word.saturated;
    telemetry_.output_V = model_input_V_ = word.volts;
    telemetry_.friction_V = telemetry_.feedback_V = Scalar(0);
    if (!hal_.dac().write(word.code)) latch(AxisFault::dac_write_failed);
  }

  [[gnu::always_inline]] constexpr Scalar velocity_of(const hal::TachometerReading& reading) const {
    return Traits::times(reading.code, parameters_.tachometer_gain) - parameters_.tachometer_offset;
  }

  /// Latches the first fault, and opens the loop unless the caller is to decide. Always returns false.
  [[gnu::noinline]] constexpr bool lose(AxisFault fault) {
    if (decides_on_sensors_ || !telemetry_.enabled) return latch(fault);
    if (telemetry_.fault == AxisFault::none) telemetry_.fault = fault;
    return false;
  }

  /// Latches the first fault and opens the loop. Always returns false, for the caller to return.
  constexpr bool latch(AxisFault fault) {
    if (telemetry_.fault == AxisFault::none) telemetry_.fault = fault;
    disable();
    is_synchronised_ = false;
    return false;
  }

  Hal& hal_;
  AxisParameters<Scalar> parameters_{};
  MotionLimits limits_{};
  Scalar counts_per_sample_per_velocity_{};
  KalmanEstimator<Scalar> estimator_;
  ReferenceGenerator generator_;
  StoppingDistance stopping_;
  std::int64_t farthest_stop_ = 0;  ///< counts, from the velocity limit
  ReferencePreview<Scalar> preview_;
  ReferenceFeedforward<Scalar> feedforward_{};
  DacConversion<Scalar> dac_;
  CountExtender counter_;
  Scalar model_input_V_{};
  AxisTelemetry<Scalar> telemetry_{};
  bool is_configured_ = false;
  bool is_synchronised_ = false;
  bool decides_on_sensors_ = true;
  bool is_open_loop_ = false;
  bool is_closed_loop_ = false;  ///< enabled, and not in open loop
  bool is_plain_loop_ = false;   ///< the same, and only backlash compensation changes the reference
  Scalar excitation_V_{};
  BacklashCrossing backlash_;
  ControlFilters<Scalar> filters_;
  DriveCompensation<Scalar> compensation_;
  PitchCorrection pitch_;
  FrictionFeedforward<Scalar> friction_;  // its tables come last, so that one load reaches each of the other members
};

}  // namespace firmware
