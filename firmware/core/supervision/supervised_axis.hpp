// One axis of a board: the control law, its monitors, its states and its capture.
#pragma once

#include <cstdint>

#include "firmware/core/axis.hpp"
#include "firmware/core/motion/homing.hpp"
#include "firmware/core/supervision/axis_index.hpp"
#include "firmware/core/supervision/axis_monitors.hpp"
#include "firmware/core/supervision/capture_ring.hpp"
#include "firmware/core/supervision/drive_sequence.hpp"
#include "firmware/core/supervision/drop_watch.hpp"
#include "firmware/core/supervision/fault_latch.hpp"
#include "firmware/core/supervision/increment_limits.hpp"
#include "firmware/core/supervision/sensor_stop.hpp"
#include "firmware/core/supervision/standstill.hpp"
#include "firmware/core/supervision/stop_end.hpp"
#include "firmware/core/supervision/supervised_check.hpp"
#include "firmware/core/supervision/supervised_hal.hpp"
#include "firmware/core/supervision/supervisor_state.hpp"
#include "firmware/core/supervision/wired_inputs.hpp"

namespace firmware {

template <typename Scalar, SupervisedHal Hal>
class SupervisedAxis {
 public:
  explicit constexpr SupervisedAxis(Hal& hal) : hal_(hal), axis_(hal) { axis_.leave_sensors_to_supervisor(); }

  /// Takes new parameters and begins the self-test; if they are wrong, returns why and keeps the old ones. Only while
  /// the outputs are off. `ShutOut` disables the control interrupt only at the beginning and at the end. In the long
  /// part between them the axis's steps do nothing.
  template <typename ShutOut = NoShutOut>
  constexpr Refusal configure(const AxisParameters<Scalar>& parameters) {
    return take<ShutOut>(parameters, check_supervised(parameters));
  }

  /// The same for an axis without a controller, for excitation in open loop only: gains and thresholds have no effect.
  constexpr Refusal configure_bare(const AxisParameters<Scalar>& parameters) {
    return take<NoShutOut>(parameters, check_sequence(parameters.sequence));
  }

  // Requests take effect in the next control period. They return false if the state does not allow them.
  constexpr bool enable() { return may_be_enabled() && request(SupervisorEvent::enable_request); }
  /// The same without the controller: the command is the value of excite().
  constexpr bool enable_open_loop() {
    if (!enable()) return false;
    axis_.open_loop();
    return true;
  }
  constexpr void feed_friction(bool on) { axis_.feed_friction(on); }  ///< as of Axis
  constexpr const Axis<Scalar, Hal>& control_law() const { return axis_; }
  constexpr void excite(Scalar volts) { axis_.excite(volts); }  ///< as of Axis
  /// Ready, and at rest for a while: a loop that closes on a moving axis would stop it with a jerk. The amplifier's
  /// ready contact must be open: a closed contact could not show when the amplifier begins to drive.
  constexpr bool may_be_enabled() const { return state_ == SupervisorState::ready && stands() && !says_ready(); }
  constexpr bool stands() const { return standstill_.stands(); }
  /// Slows down, then drops the enable.
  constexpr bool disable() { return is_enabled_or_starting() && request(SupervisorEvent::disable_request); }
  /// Clears fault and capture; the self-test decides what comes next.
  constexpr bool clear_fault() {
    if (state_ != SupervisorState::fault) return false;
    latched_.clear();
    must_cut_power_ = false;
    axis_.clear_fault();
    capture_.restart();
    begin_self_test();
    advance_by(SupervisorEvent::clear_request);
    return true;
  }

  /// As for Axis, while the state is enabled; false otherwise.
  constexpr bool jog(Scalar velocity) {
    if (state_ != SupervisorState::enabled || homing_.is_active() || !has_room_towards(velocity)) return false;
    limiting_.velocity_limited =
        velocity > axis_.parameters().velocity_limit || velocity < Scalar(0) - axis_.parameters().velocity_limit;
    is_interpolated_ = false;
    return axis_.jog(velocity);
  }
  constexpr bool start(const MovePlan& plan) {
    is_interpolated_ = false;
    return state_ == SupervisorState::enabled && !homing_.is_active() && axis_.start(plan);
  }
  /// No move leads beyond the travel (TravelMonitor).
  constexpr MovePlanResult plan_move_to(const CountPosition& target) const {
    if (!may_reach(target.counts)) return {{}, Refusal::outside_travel};
    return axis_.plan_move_to(target);
  }
  constexpr MovePlanResult plan_move_by(std::int64_t counts, std::int32_t unhomed_share = kWholeVelocity) const {
    const std::int64_t here = axis_.telemetry().reference.counts;
    if (!monitors_.travel().has_way(here, counts)) return {{}, Refusal::outside_travel};
    return axis_.plan_move_by(counts, is_homed() ? kWholeVelocity : unhomed_share);
  }
  /// False at a limit of travel that a jog of this velocity would pass.
  constexpr bool has_room_towards(Scalar velocity) const {
    return velocity == Scalar(0) ||
           monitors_.travel().has_room(axis_.telemetry().reference.counts, velocity > Scalar(0));
  }
  constexpr void stop() {
    if (homing_.is_active()) monitors_.bound_travel_from(axis_.telemetry().encoder_counts);
    homing_.abandon();
    axis_.stop();
  }

  /// Begins homing, from rest. False while the axis is not enabled, moves, or its homing mode finds nothing.
  constexpr bool home() {
    if (state_ != SupervisorState::enabled || !is_at_rest() || !homing_.begin()) return false;
    if constexpr (kHasIndexPulse<Hal>) static_cast<void>(look_at_index());  // earlier pulses
    is_interpolated_ = false;
    is_guided_ = true;
    axis_.forget_home();
    monitors_.unbound_travel();
    return true;
  }
  /// The operator states that the axis is at `position`, counts. False while it moves.
  constexpr bool set_position(std::int64_t position) {
    if (homing_.is_active() || (outputs_are_on(state_) && !is_at_rest())) return false;
    count_from(position - axis_.telemetry().encoder_counts);
    return true;
  }
  constexpr void forget_home() { axis_.forget_home(); }
  constexpr void use_pitch_table(PitchTable table) { axis_.use_pitch_table(table); }  ///< as of Axis
  constexpr bool is_homed() const { return axis_.telemetry().homed; }
  constexpr bool is_homing() const { return homing_.is_active(); }
  constexpr std::int64_t index_way() const { return homing_.index_way(); }  ///< as of HomingSequence

  constexpr std::int64_t table_counts_at(std::uint32_t reading) const { return axis_.table_counts_at(reading); }
  constexpr hal::EncoderReading read_encoder() { return hal_.encoder().read(); }
  /// Whether it read the index in its last step; the other axes of a group read theirs in other samples.
  constexpr bool has_looked_at_index() const { return index_.has_just_looked(); }
  constexpr void leave_index_for_later() { index_.leave_for_later(); }
  constexpr void bridge_gap(const hal::EncoderReading& encoder) { axis_.bridge_gap(encoder); }  ///< as of Axis

  constexpr CountPosition leading() const { return axis_.leading(); }  ///< as of Axis
  /// Whether a path or a move may lead there.
  constexpr bool may_reach(std::int64_t counts) const { return monitors_.travel().is_inside(counts); }

  /// The next step is a step_with() of this increment.
  constexpr void lead(Increment increment) {
    led_increment_ = increment;
    is_led_ = is_guided_ = true;
  }

  /// One control period with the axis's own reference. `outer`: a fault found outside the axis.
  constexpr void step(AxisFault outer = AxisFault::none) { step(outer, read_encoder()); }
  constexpr void step(AxisFault outer, const hal::EncoderReading& encoder) {
    if (is_guided_) return step_guided(outer, encoder);
    if (state_ == SupervisorState::enabled && monitors_.travel().is_near_end()) keep_inside();
    axis_.step(encoder);
    supervise(outer);
  }

  /// One control period plus an interpolator's increment; a stopping or homing axis ignores it.
  constexpr void step_with(Increment increment, AxisFault outer = AxisFault::none) {
    step_with(increment, outer, read_encoder());
  }
  constexpr void step_with(Increment increment, AxisFault outer, const hal::EncoderReading& encoder) {
    is_led_ = false;
    if (state_ != SupervisorState::enabled || homing_.is_active()) return step_by_itself(outer, encoder);
    is_guided_ = false;
    is_interpolated_ = true;
    if (!increments_.allow(increment, axis_.newest_increment())) {
      axis_.stop_interpolated();  // an impossible increment never reaches the drive
      axis_.step(encoder);
      return supervise(outer == AxisFault::none ? AxisFault::reference_out_of_limits : outer);
    }
    increments_.take(increment);
    axis_.step_with(increment, encoder);
    supervise(outer);
  }

  constexpr SupervisorState state() const { return state_; }
  constexpr bool is_enabled_or_starting() const {
    return state_ == SupervisorState::enabled || state_ == SupervisorState::starting;
  }
  /// The outputs are on, or will be in the next control period.
  constexpr bool is_or_will_be_on() const {
    return outputs_are_on(state_) || contains(requests_, SupervisorEvent::enable_request);
  }
  constexpr AxisFault fault() const { return latched_.first(); }
  /// Whether a new fault occurred since the last call.
  constexpr bool take_new_fault() { return latched_.take_new(); }
  /// The fault that stopped it since the last clear_fault().
  constexpr const FaultLatch& latched() const { return latched_; }
  /// The amplifier still drives although its enable has dropped. Until clear_fault().
  constexpr bool must_cut_power() const { return must_cut_power_; }
  constexpr LimitingReasons limiting() const { return {axis_.telemetry().saturated, limiting_.velocity_limited}; }
  constexpr bool is_at_rest() const { return axis_.is_at_rest(); }
  constexpr const AxisTelemetry<Scalar>& telemetry() const { return axis_.telemetry(); }
  constexpr const AxisParameters<Scalar>& parameters() const { return axis_.parameters(); }
  constexpr CountPosition table_reference() const { return axis_.table_reference(); }
  constexpr const Axis<Scalar, Hal>& law() const { return axis_; }
  constexpr const AxisMonitors<Scalar>& monitors() const { return monitors_; }
  constexpr const CaptureRing<Scalar>& capture() const { return capture_; }
  constexpr Hal& hal() const { return hal_; }

 private:
  template <typename ShutOut>
  constexpr Refusal take(const AxisParameters<Scalar>& parameters, Refusal error) {
    if (outputs_are_on(state_)) return Refusal::controller_is_enabled;
    if (error != Refusal::none) return error;
    {
      [[maybe_unused]] const ShutOut guard{};
      is_guided_ = stands_aside_ = true;
    }
    error = prepare(parameters);
    [[maybe_unused]] const ShutOut guard{};
    is_guided_ = stands_aside_ = false;
    if (error != Refusal::none) return error;
    begin_self_test();
    advance_by(SupervisorEvent::configured);
    return error;
  }

  constexpr Refusal prepare(const AxisParameters<Scalar>& parameters) {
    const Refusal error = axis_.configure(parameters);
    if (error != Refusal::none) return error;
    monitors_.configure(parameters, axis_.farthest_stop(), axis_.largest_offset());
    homing_.configure(parameters.homing);
    sequence_.configure(parameters.sequence);
    index_.configure(parameters.monitors.index_spacing);
    inputs_.configure(parameters);
    for (InputFilter* input : {&drive_fault_, &home_switch_}) input->configure(parameters.monitors.input_samples);
    const MotionLimits limits = motion_limits(parameters);
    increments_.configure(limits);
    stop_end_.configure(limits);
    sensor_stop_.configure(parameters);
    drop_watch_.configure(parameters);
    standstill_.configure(monitors_.travel().play());
    capture_.configure(parameters.monitors.capture_stride);
    return error;
  }

  /// Ends a jog so early that the play of a loop that holds its position stays within the limit.
  [[gnu::noinline]] constexpr void keep_inside() {
    const TravelMonitor<Scalar>& travel = monitors_.travel();
    axis_.keep_inside(travel.min_counts() + travel.play(), travel.max_counts() - travel.play());
  }

  constexpr bool request(SupervisorEvent event) {
    requests_ = requests_ | event;
    return true;
  }

  constexpr void advance_by(SupervisorEvent event) {
    enter(next_state(state_, event | event, latched_.first() != AxisFault::none));
  }

  /// The stop computes the command. Faults of amplifier, converter and board drop the enable, as does a drive that does
  /// not obey; readings of the failed sensor are no longer faults.
  [[gnu::noinline]] constexpr void step_sensor_stop(AxisFault outer, const hal::EncoderReading& encoder) {
    const bool is_lost = sensor_stop_.uses_encoder() && !encoder.valid;
    axis_.step_with_command(encoder, sensor_stop_.command_V(), sensor_stop_.velocity());
    const AxisFault own = watch_lines();
    if (reaction_to(outer) != FaultReaction::drop_enable) outer = AxisFault::none;  // the axis stops already
    if (!sensor_stop_.next(axis_.telemetry()) || is_lost) requests_ = requests_ | SupervisorEvent::drop_fault;
    advance(outer, own);
  }

  /// For an axis that follows a path, homes, or stops by one sensor.
  [[gnu::noinline]] constexpr void step_guided(AxisFault outer, const hal::EncoderReading& encoder) {
    is_led_ ? step_with(led_increment_, outer, encoder) : step_by_itself(outer, encoder);
  }

  /// For an axis that follows only its own reference.
  [[gnu::noinline]] constexpr void step_by_itself(AxisFault outer, const hal::EncoderReading& encoder) {
    if (stands_aside_) return;
    if (sensor_stop_.is_active()) return step_sensor_stop(outer, encoder);
    is_guided_ = homing_.is_active();
    axis_.step(encoder);
    supervise(is_guided_ && outer == AxisFault::none ? guide_home() : outer);
  }

  /// After each step of a homing axis: the next request of the sequence, and its fault.
  [[gnu::noinline]] constexpr AxisFault guide_home() {
    HomingInputs seen{.counts = axis_.telemetry().encoder_counts,
                      .at_switch = home_switch_.filtered(hal_.limits().read().home),
                      .at_rest = axis_.is_at_rest()};
    if constexpr (kHasIndexPulse<Hal>) {
      const AxisFault miscounted = look_at_index();
      if (miscounted != AxisFault::none) return miscounted;
      seen.index_seen = index_.seen().seen;
      seen.index_counts = axis_.counts_at(index_.seen().counts);
    }
    const HomingAction<Scalar> action = homing_.next(seen);
    if (action.step == HomingStep::jog) axis_.jog(action.velocity);
    if (action.step == HomingStep::stop) axis_.stop();
    if (action.step == HomingStep::arrived) count_from(homing_.parameters().position - action.found);
    return action.step == HomingStep::failed ? action.fault : AxisFault::none;
  }

  constexpr void count_from(std::int64_t origin) {
    axis_.set_home(origin);
    monitors_.bound_travel_by_limits();
    standstill_.shift(origin);
    stop_end_.shift(origin);
  }

  constexpr void begin_self_test() {
    monitors_.restart();
    index_.restart();
    self_test_samples_ = 0;
  }

  constexpr void supervise(AxisFault outer) {
    const AxisTelemetry<Scalar>& seen = axis_.telemetry();
    AxisFault own = watch(seen);
    if constexpr (kHasIndexPulse<Hal>)
      if (index_.is_due() && own == AxisFault::none) own = look_at_index();
    if (own == AxisFault::none && outer == AxisFault::none) {
      capture_.take(seen);
      if (state_ == SupervisorState::enabled && requests_ == 0) return;
    }
    advance(outer, own);
  }

  /// The motion is monitored until the outputs are off, even after a fault from outside.
  constexpr AxisFault watch(const AxisTelemetry<Scalar>& seen) {
    if (seen.fault != AxisFault::none) return seen.fault;
    const AxisFault lines = watch_lines();
    if (lines != AxisFault::none) return lines;
    const AxisFault sensors = monitors_.watch_sensors(seen);
    if (sensors != AxisFault::none) return inputs_.says_broken(hal_.encoder()) ? AxisFault::encoder_invalid : sensors;
    if (!seen.enabled) return watch_rest(seen);
    const AxisFault inputs = inputs_.has_any() ? inputs_.watch(hal_, true) : AxisFault::none;
    if (inputs != AxisFault::none) return inputs;
    const AxisFault motion = monitors_.watch_motion(seen);
    return motion != AxisFault::none ? motion : monitors_.watch_travel(seen, hal_.limits());
  }

  [[gnu::noinline]] constexpr AxisFault watch_rest(const AxisTelemetry<Scalar>& seen) {
    standstill_.watch(seen.encoder_counts);
    const AxisFault inputs = inputs_.watch(hal_, false);
    return inputs != AxisFault::none ? inputs : monitors_.watch_rest(seen);
  }

  /// Faults of amplifier and converter.
  [[gnu::always_inline]] constexpr AxisFault watch_lines() {
    const bool says_fault = hal_.drive_enable().is_faulted();
    if ((says_fault || drive_fault_.is_pending()) && drive_fault_.filtered(says_fault)) return AxisFault::drive_fault;
    return monitors_.watch_parts(hal_);
  }

  [[gnu::noinline]] constexpr AxisFault look_at_index() { return index_.look(hal_.encoder(), axis_.encoder_reading()); }
  constexpr bool says_ready() const { return sequence_.parameters().ready_input && is_ready(hal_.drive_enable()); }

  /// Without an enable.
  constexpr AxisFault watch_off(AxisFault own) {
    const MonitorLimits<Scalar>& limits = axis_.parameters().monitors;
    if (!drop_watch_.is_driven(limits, says_ready(), monitors_.slowest(axis_.telemetry()))) return own;
    must_cut_power_ = true;
    return own == AxisFault::none ? AxisFault::drive_not_off : own;
  }

  constexpr void release_brake(bool released) { sequence_.release_brake(hal_.drive_enable(), released); }

  /// Towards a closed loop and a released brake, while the state is starting. The axis may not move until the loop is
  /// closed.
  constexpr SupervisorEvents start_drive() {
    const bool is_held = axis_.telemetry().enabled && !axis_.is_open_loop();
    if (!is_held && standstill_.has_moved(axis_.telemetry().encoder_counts))
      return latch(AxisFault::moved_while_starting) | SupervisorEvent::drop_fault;
    switch (sequence_.next(is_ready(hal_.drive_enable()))) {
      case DriveStep::close_loop:
        axis_.enable();
        release_brake(true);
        return 0;
      case DriveStep::started:
        return SupervisorEvent::started | SupervisorEvent::started;
      case DriveStep::late:
        return latch(AxisFault::amplifier_not_ready) | SupervisorEvent::drop_fault;
      default:
        return 0;
    }
  }

  /// Handles the rare cases: faults, requests, and all states except a closed loop in normal operation.
  [[gnu::noinline]] constexpr void advance(AxisFault outer, AxisFault own) {
    SupervisorEvents events = requests_;
    requests_ = 0;
    if (state_ == SupervisorState::off && events == 0) return;
    if (!outputs_are_on(state_) && events == 0) own = watch_off(own);
    if (outer == AxisFault::other_axis_stopped && own != AxisFault::none) outer = AxisFault::none;
    for (const AxisFault found : {outer, own})
      if (found != AxisFault::none) events = events | latch(found);
    if (state_ == SupervisorState::self_test && ++self_test_samples_ >= kSelfTestSamples)
      events = events | SupervisorEvent::test_passed;
    if (state_ == SupervisorState::starting && events == 0) events = start_drive();
    if (state_ == SupervisorState::stopping && has_stopped() && brake_holds())
      events = events | SupervisorEvent::standing;
    if (events != 0) enter(next_state(state_, events, latched_.first() != AxisFault::none));
  }

  /// A fault takes effect once it is latched.
  constexpr SupervisorEvent latch(AxisFault found) {
    const bool drops = reaction_to(found) != FaultReaction::ramp_stop && !begin_sensor_stop(found);
    if (latched_.first() == AxisFault::none)
      latch_first(found);
    else if (outputs_are_on(state_))
      latched_.add(found);
    if (loses_position(found)) axis_.forget_home();
    return drops ? SupervisorEvent::drop_fault : SupervisorEvent::ramp_fault;
  }

  /// False if no sensor is left that shows the drive's speed, or the loop is open.
  constexpr bool begin_sensor_stop(AxisFault found) {
    if (reaction_to(found) != FaultReaction::sensor_stop || sensor_stop_.is_active()) return false;
    const AxisTelemetry<Scalar>& seen = axis_.telemetry();
    const TrustedSensor trusted = sensor_stop_.trusted_after(found, seen);
    if (!seen.enabled || axis_.is_open_loop() || trusted == TrustedSensor::none) return false;
    sensor_stop_.begin(trusted, found, seen, monitors_.effort().load_V());
    is_guided_ = true;
    return true;
  }

  constexpr void latch_first(AxisFault found) {
    const AxisActivity activity =
        activity_of(state_, homing_.is_active(), axis_.is_open_loop(), axis_.is_at_rest(), is_interpolated_);
    latched_.begin(found, activity, is_homed());
    capture_.freeze(axis_.telemetry());
    axis_.brake_hard();
  }

  constexpr bool brake_holds() {
    sequence_.begin_braking();
    release_brake(false);
    return sequence_.next(true) == DriveStep::held;
  }

  constexpr bool has_stopped() {
    if (sequence_.is_braking()) return true;
    if (sensor_stop_.is_active()) return sensor_stop_.has_stopped();
    return stop_end_.has_stopped(axis_.is_at_rest(), !axis_.is_open_loop(), axis_.telemetry().encoder_counts);
  }

  constexpr void enter(SupervisorState next) {
    if (next == state_) return;
    const bool was_on = outputs_are_on(state_);
    if (next == SupervisorState::starting && sequence_.starts_at_once()) next = SupervisorState::enabled;
    if (next == SupervisorState::stopping && !axis_.telemetry().enabled)  // no loop to slow it down
      next = latched_.first() == AxisFault::none ? SupervisorState::ready : SupervisorState::fault;
    state_ = next;
    homing_.abandon();
    sequence_.end();
    if (next == SupervisorState::starting) {
      sequence_.begin_start();
      standstill_.begin_start(axis_.telemetry().encoder_counts);
      axis_.energise();
    }
    if (next == SupervisorState::enabled) {
      if (axis_.enable()) {
        release_brake(true);
      } else {
        latch_first(axis_.telemetry().fault);
        state_ = SupervisorState::fault;
      }
    }
    if (next == SupervisorState::stopping && !sensor_stop_.is_active()) {
      is_interpolated_ ? axis_.stop_interpolated() : axis_.stop();
      stop_end_.begin();
    }
    if (!outputs_are_on(state_)) {
      is_interpolated_ = limiting_.velocity_limited = false;
      increments_.restart();
      release_brake(false);
      sensor_stop_.end();
      if (was_on) drop_watch_.begin();
      if (was_on) standstill_.restart(axis_.telemetry().encoder_counts);
      axis_.disable();
    }
  }

  Hal& hal_;
  AxisMonitors<Scalar> monitors_;
  HomingSequence<Scalar> homing_;
  DriveSequence sequence_;
  AxisIndex index_;
  WiredInputs inputs_;
  InputFilter drive_fault_, home_switch_;
  SupervisorState state_ = SupervisorState::off;
  SupervisorEvents requests_ = 0;
  FaultLatch latched_;
  LimitingReasons limiting_{};
  bool is_interpolated_ = false;
  IncrementLimits increments_;
  Increment led_increment_ = 0;
  bool is_led_ = false;
  bool is_guided_ = false;  ///< on a path, homing or being configured: the next step may be a different one
  bool stands_aside_ = false;
  std::int32_t self_test_samples_ = 0;
  Standstill standstill_;
  StopEnd stop_end_;
  SensorStop<Scalar> sensor_stop_;
  DropWatch<Scalar> drop_watch_;
  bool must_cut_power_ = false;
  Axis<Scalar, Hal> axis_;  // the large tables come last: a load reaches no farther than 1 to 4 kB
  CaptureRing<Scalar> capture_;
};

}  // namespace firmware
