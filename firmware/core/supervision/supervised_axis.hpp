// One axis as a board runs it: the control law, the monitors that watch it, its states and its capture.
#pragma once

#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>

#include "firmware/core/axis.hpp"
#include "firmware/core/motion/homing.hpp"
#include "firmware/core/supervision/axis_monitors.hpp"
#include "firmware/core/supervision/capture_ring.hpp"
#include "firmware/core/supervision/drive_sequence.hpp"
#include "firmware/core/supervision/fault_table.hpp"
#include "firmware/core/supervision/index_monitor.hpp"
#include "firmware/core/supervision/standstill.hpp"
#include "firmware/core/supervision/stop_end.hpp"
#include "firmware/core/supervision/supervised_check.hpp"
#include "firmware/core/supervision/supervisor_state.hpp"

namespace firmware {

/// An axis's hardware and its switches.
template <typename T>
concept SupervisedHal = hal::AxisHal<T> && requires(T& axis) {
  requires hal::LimitInputs<std::remove_reference_t<decltype(axis.limits())>>;
};

/// What holds the motion back without being a fault.
struct LimitingReasons {
  bool saturated = false;         ///< the D/A converter is at its limit
  bool velocity_limited = false;  ///< a jog asked for more than the velocity limit, and got that limit
};

template <typename Scalar, SupervisedHal Hal>
class SupervisedAxis {
 public:
  explicit constexpr SupervisedAxis(Hal& hal) : hal_(hal), axis_(hal) {}

  /// Takes new parameters and begins the self-test, or says what is wrong and keeps the old. Only while the outputs are
  /// off.
  constexpr Refusal configure(const AxisParameters<Scalar>& parameters) {
    if (outputs_are_on(state_)) return Refusal::controller_is_enabled;
    const Refusal error = check_supervised(parameters);
    return error == Refusal::none ? take(parameters) : error;
  }

  /// Likewise for an axis that has no controller yet and is to be excited in open loop alone: gains and thresholds mean
  /// nothing, and whoever lets it be enabled otherwise is wrong.
  constexpr Refusal configure_bare(const AxisParameters<Scalar>& parameters) {
    return outputs_are_on(state_) ? Refusal::controller_is_enabled : take(parameters);
  }

  // What comes of a request shows in the next control period. False where the state does not allow it.
  constexpr bool enable() { return may_be_enabled() && request(SupervisorEvent::enable_request); }
  /// Likewise without the controller: the command is what excite() is told.
  constexpr bool enable_open_loop() {
    if (!enable()) return false;
    axis_.open_loop();
    return true;
  }
  /// As of Axis.
  constexpr void excite(Scalar volts) { axis_.excite(volts); }
  /// Ready, and the encoder has stood for a while: a loop that closes on a moving axis would jerk it to a stop.
  constexpr bool may_be_enabled() const { return state_ == SupervisorState::ready && stands(); }
  constexpr bool stands() const { return standstill_.stands(); }
  /// Slows down, then drops the enable.
  constexpr bool disable() { return is_enabled_or_starting() && request(SupervisorEvent::disable_request); }
  /// Forgets fault and capture; the self-test decides what comes next.
  constexpr bool clear_fault() {
    if (state_ != SupervisorState::fault) return false;
    fault_ = second_fault_ = AxisFault::none;
    is_fault_new_ = false;
    axis_.clear_fault();
    capture_.restart();
    begin_self_test();
    advance_by(SupervisorEvent::clear_request);
    return true;
  }

  /// As of Axis, while the state is enabled; false otherwise.
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
  /// A homed axis plans no move beyond its travel; an axis that is not homed knows of none.
  constexpr MovePlanResult plan_move_to(const CountPosition& target) const {
    if (is_homed() && !monitors_.travel().is_inside(target.counts)) return {{}, Refusal::outside_travel};
    return axis_.plan_move_to(target);
  }
  constexpr MovePlanResult plan_move_by(std::int64_t counts) const {
    const std::int64_t here = axis_.telemetry().reference.counts;
    if (is_homed() && !monitors_.travel().has_way(here, counts)) return {{}, Refusal::outside_travel};
    return axis_.plan_move_by(counts);
  }
  /// False at a limit of travel that a jog of this velocity would pass.
  constexpr bool has_room_towards(Scalar velocity) const {
    return velocity == Scalar(0) || !is_homed() ||
           monitors_.travel().has_room(axis_.telemetry().reference.counts, velocity > Scalar(0));
  }
  constexpr void stop() {
    homing_.abandon();
    axis_.stop();
  }

  /// Begins to look for home, from rest. False while the axis is not enabled, moves, or has nothing to look for.
  constexpr bool home() {
    if (state_ != SupervisorState::enabled || !is_at_rest() || !homing_.begin()) return false;
    if constexpr (kHasIndex) hal_.encoder().read_index();  // pulses of the time before
    is_interpolated_ = false;
    is_guided_ = true;
    axis_.forget_home();  // the limits of an old home must not stand in the way
    return true;
  }
  /// The operator says that the axis stands at `position`, counts. False while it moves.
  constexpr bool set_position(std::int64_t position) {
    if (homing_.is_active() || (outputs_are_on(state_) && !is_at_rest())) return false;
    count_from(position - axis_.telemetry().encoder_counts);
    return true;
  }
  constexpr void forget_home() { axis_.forget_home(); }
  constexpr bool is_homed() const { return axis_.telemetry().homed; }
  constexpr bool is_homing() const { return homing_.is_active(); }

  /// For steps of several axes, which are read at one instant.
  constexpr hal::EncoderReading read_encoder() { return hal_.encoder().read(); }
  /// In its last step it looked at the index: the others of a group do that in a sample of their own.
  constexpr bool has_looked_at_index() const { return until_index_ == kIndexSamples; }
  constexpr void leave_index_for_later() { until_index_ = until_index_ <= 1 ? 2 : until_index_; }
  /// As of Axis, before a step that comes late.
  constexpr void bridge_gap(const hal::EncoderReading& encoder) { axis_.bridge_gap(encoder); }

  /// As of Axis.
  constexpr CountPosition leading() const { return axis_.leading(); }
  /// A place that a path may lead to: of a homed axis within its travel.
  constexpr bool may_reach(std::int64_t counts) const { return !is_homed() || monitors_.travel().is_inside(counts); }

  /// The next step is a step_with() of this increment.
  constexpr void lead(Increment increment) {
    led_increment_ = increment;
    is_led_ = is_guided_ = true;
  }

  /// One control period with the axis's own reference. `outer`: a fault that was found outside the axis.
  constexpr void step(AxisFault outer = AxisFault::none) { step(outer, read_encoder()); }
  constexpr void step(AxisFault outer, const hal::EncoderReading& encoder) {
    if (is_guided_) return step_guided(outer, encoder);
    if (state_ == SupervisorState::enabled && monitors_.travel().is_near_end()) keep_inside();
    axis_.step(encoder);
    supervise(outer);
  }

  /// One control period with an interpolator's increment on top; a stopping or homing axis goes its own way.
  constexpr void step_with(Increment increment, AxisFault outer = AxisFault::none) {
    step_with(increment, outer, read_encoder());
  }
  constexpr void step_with(Increment increment, AxisFault outer, const hal::EncoderReading& encoder) {
    is_led_ = false;
    if (state_ != SupervisorState::enabled || homing_.is_active()) return step(outer, encoder);
    is_interpolated_ = true;
    if (!is_within_limits(increment)) {
      axis_.stop_interpolated();  // what cannot be right never reaches the drive
      axis_.step(encoder);
      return supervise(outer == AxisFault::none ? AxisFault::reference_out_of_limits : outer);
    }
    last_increment_ = increment;
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
  /// The first fault since the last clear_fault().
  constexpr AxisFault fault() const { return fault_; }
  /// Whether it came since this was asked last.
  constexpr bool take_new_fault() {
    if (!is_fault_new_) return false;
    is_fault_new_ = false;
    return true;
  }
  /// What went wrong besides while the first fault brought the axis to a stop; the worst of it. none: nothing.
  constexpr AxisFault second_fault() const { return second_fault_; }
  constexpr LimitingReasons limiting() const {
    return {.saturated = axis_.telemetry().saturated, .velocity_limited = limiting_.velocity_limited};
  }
  constexpr bool is_at_rest() const { return axis_.is_at_rest(); }
  constexpr const AxisTelemetry<Scalar>& telemetry() const { return axis_.telemetry(); }
  constexpr const AxisParameters<Scalar>& parameters() const { return axis_.parameters(); }
  constexpr CountPosition table_reference() const { return axis_.table_reference(); }
  constexpr const AxisMonitors<Scalar>& monitors() const { return monitors_; }
  constexpr const CaptureRing<Scalar>& capture() const { return capture_; }
  constexpr Hal& hal() { return hal_; }

 private:
  static constexpr bool kHasIndex =
      hal::IndexedEncoder<std::remove_reference_t<decltype(std::declval<Hal&>().encoder())>>;
  static constexpr std::int32_t kIndexSamples = 16;  ///< from one look at the index to the next

  constexpr Refusal take(const AxisParameters<Scalar>& parameters) {
    const Refusal error = axis_.configure(parameters);
    if (error != Refusal::none) return error;
    monitors_.configure(parameters, axis_.farthest_stop());
    homing_.configure(parameters.homing);
    sequence_.configure(parameters.sequence);
    index_.configure(parameters.monitors.index_spacing);
    until_index_ = 1;
    for (InputFilter* input : {&drive_fault_, &drive_unready_, &home_switch_})
      input->configure(parameters.monitors.input_samples);
    const MotionLimits limits = motion_limits(parameters);
    fastest_ = static_cast<std::uint32_t>((limits.velocity + (limits.velocity >> 4)) >> 32) + 2;  // 2: rounding
    const Increment sharpest =
        limits.acceleration < kMostMotion / 8 ? 8 * limits.acceleration : kMostMotion;  // corners
    largest_change_ = static_cast<std::uint32_t>(sharpest >> 32) + 2;
    stop_end_.configure(limits);
    standstill_.configure(monitors_.travel().play());
    capture_.configure(parameters.monitors.capture_stride);
    begin_self_test();
    advance_by(SupervisorEvent::configured);
    return error;
  }

  /// A jog ends where the play of a loop that holds its place does not reach beyond the limit.
  [[gnu::noinline]] constexpr void keep_inside() {
    if (!is_homed()) return;
    const TravelMonitor<Scalar>& travel = monitors_.travel();
    axis_.keep_inside(travel.min_counts() + travel.play(), travel.max_counts() - travel.play());
  }

  /// Of the whole reference: the axis's own, as it was in the last sample, and the increment on top. By the upper
  /// words, 2^-16 counts.
  constexpr bool is_within_limits(Increment increment) const {
    const auto upper = [](Increment value) { return static_cast<std::uint32_t>(value >> 32); };
    const std::uint32_t change = upper(increment) - upper(last_increment_);
    const std::uint32_t whole = upper(axis_.newest_increment()) + change;
    return whole + fastest_ <= 2 * fastest_ && change + largest_change_ <= 2 * largest_change_;
  }

  constexpr bool request(SupervisorEvent event) {
    requests_ = requests_ | event;
    return true;
  }

  constexpr void advance_by(SupervisorEvent event) {
    enter(next_state(state_, event | event, fault_ != AxisFault::none));
  }

  /// Of an axis that is led or looks for home.
  [[gnu::noinline]] constexpr void step_guided(AxisFault outer, const hal::EncoderReading& encoder) {
    is_guided_ = homing_.is_active();
    if (is_led_) return step_with(led_increment_, outer, encoder);
    axis_.step(encoder);
    supervise(is_guided_ && outer == AxisFault::none ? guide_home() : outer);
  }

  /// After each step of a homing axis: what the sequence wants next, and its fault.
  [[gnu::noinline]] constexpr AxisFault guide_home() {
    HomingInputs seen;
    seen.counts = axis_.telemetry().encoder_counts;
    seen.at_switch = home_switch_.filtered(hal_.limits().read().home);
    seen.at_rest = axis_.is_at_rest();
    if constexpr (kHasIndex) {
      const hal::IndexReading index = hal_.encoder().read_index();
      if (index_.is_on()) index_.watch(index, axis_.encoder_reading());
      seen.index_seen = index.seen;
      seen.index_counts = axis_.counts_at(index.counts);
    }
    const HomingAction<Scalar> action = homing_.next(seen);
    switch (action.step) {
      case HomingStep::wait:
        break;
      case HomingStep::jog:
        axis_.jog(action.velocity);
        break;
      case HomingStep::stop:
        axis_.stop();
        break;
      case HomingStep::arrived:
        count_from(homing_.parameters().position - action.found);
        break;
      case HomingStep::failed:
        return action.fault;
    }
    return AxisFault::none;
  }

  constexpr void count_from(std::int64_t origin) {
    axis_.set_home(origin);
    monitors_.forget_travel();
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
    if constexpr (kHasIndex)
      if (--until_index_ <= 0 && own == AxisFault::none) own = watch_index();
    if (own == AxisFault::none && outer == AxisFault::none) {
      capture_.take(seen);
      if (state_ == SupervisorState::enabled && requests_ == 0) return;
    }
    advance(outer, own);
  }

  /// Whatever is wrong outside: what the axis does is watched until its outputs are off.
  constexpr AxisFault watch(const AxisTelemetry<Scalar>& seen) {
    if (seen.fault != AxisFault::none) return seen.fault;
    const bool says_fault = hal_.drive_enable().is_faulted();
    if ((says_fault || drive_fault_.is_pending()) && drive_fault_.filtered(says_fault)) return AxisFault::drive_fault;
    const AxisFault parts = monitors_.watch_parts(hal_);
    if (parts != AxisFault::none) return parts;
    const AxisFault sensors = monitors_.watch_sensors(seen);
    if (sensors != AxisFault::none) return sensors;
    if (!seen.enabled) {
      standstill_.watch(seen.encoder_counts);
      return monitors_.watch_rest(seen);
    }
    if (sequence_.parameters().ready_input && drive_unready_.filtered(!is_ready(hal_.drive_enable())))
      return AxisFault::amplifier_not_ready;
    const AxisFault motion = monitors_.watch_motion(seen);
    return motion != AxisFault::none ? motion : monitors_.watch_travel(seen, hal_.limits());
  }

  /// Index pulses are whole turns apart however seldom they are asked for.
  [[gnu::noinline]] constexpr AxisFault watch_index() {
    until_index_ = index_.is_on() ? kIndexSamples : std::numeric_limits<std::int32_t>::max();
    if (!index_.is_on()) return AxisFault::none;
    return index_.watch(hal_.encoder().read_index(), axis_.encoder_reading());
  }

  constexpr void release_brake(bool released) { sequence_.release_brake(hal_.drive_enable(), released); }

  /// Towards a closed loop and a released brake, while the state is starting. Until the loop is closed nothing may
  /// move: an amplifier with an offset and a converter that is stuck drive the axis as soon as it has its enable.
  constexpr SupervisorEvents start_drive() {
    const bool is_held = axis_.telemetry().enabled && !axis_.is_open_loop();
    if (!is_held && standstill_.has_moved(axis_.telemetry().encoder_counts))
      return latch(AxisFault::moved_while_starting) | SupervisorEvent::drop_fault;
    switch (sequence_.next_of_start(is_ready(hal_.drive_enable()), axis_.telemetry().enabled)) {
      case DriveStartStep::wait:
        break;
      case DriveStartStep::close_loop:
        axis_.enable();
        release_brake(true);
        break;
      case DriveStartStep::started:
        return SupervisorEvent::started | SupervisorEvent::started;
      case DriveStartStep::late:
        return latch(AxisFault::amplifier_not_ready) | SupervisorEvent::drop_fault;
    }
    return 0;
  }

  /// What is rare: faults, requests, and all states but a closed loop that simply runs.
  [[gnu::noinline]] constexpr void advance(AxisFault outer, AxisFault own) {
    SupervisorEvents events = requests_;
    requests_ = 0;
    if (state_ == SupervisorState::off && events == 0) return;
    if (outer == AxisFault::other_axis_stopped && own != AxisFault::none) outer = AxisFault::none;
    for (const AxisFault found : {outer, own})
      if (found != AxisFault::none) events = events | latch(found);
    if (state_ == SupervisorState::self_test && ++self_test_samples_ >= kSelfTestSamples)
      events = events | SupervisorEvent::test_passed;
    if (state_ == SupervisorState::starting && events == 0) events = start_drive();
    if (state_ == SupervisorState::stopping && has_stopped() && brake_holds())
      events = events | SupervisorEvent::standing;
    if (events != 0) enter(next_state(state_, events, fault_ != AxisFault::none));
  }

  /// The first fault is the one that is reported; of those that follow before the outputs are off, the first of the
  /// worst kind is reported beside it.
  constexpr SupervisorEvent latch(AxisFault found) {
    const bool drops = reaction_to(found) != FaultReaction::ramp_stop;
    if (loses_position(found)) axis_.forget_home();
    if (fault_ == AxisFault::none)
      latch_first(found);
    else if (found != fault_ && outputs_are_on(state_) &&
             (second_fault_ == AxisFault::none || (drops && reaction_to(second_fault_) == FaultReaction::ramp_stop)))
      second_fault_ = found;
    return drops ? SupervisorEvent::drop_fault : SupervisorEvent::ramp_fault;
  }

  constexpr void latch_first(AxisFault found) {
    fault_ = found;
    is_fault_new_ = true;
    capture_.freeze(axis_.telemetry());
  }

  constexpr bool brake_holds() {
    if (!is_braking_) sequence_.begin();
    is_braking_ = true;
    release_brake(false);
    return sequence_.brake_holds();
  }

  constexpr bool has_stopped() {
    return is_braking_ ||
           stop_end_.has_stopped(axis_.is_at_rest(), !axis_.is_open_loop(), axis_.telemetry().encoder_counts);
  }

  constexpr void enter(SupervisorState next) {
    if (next == state_) return;
    if (next == SupervisorState::starting && sequence_.starts_at_once()) next = SupervisorState::enabled;
    if (next == SupervisorState::stopping && !axis_.telemetry().enabled)  // no loop that could slow it down
      next = fault_ == AxisFault::none ? SupervisorState::ready : SupervisorState::fault;
    state_ = next;
    homing_.abandon();
    is_braking_ = false;
    if (next == SupervisorState::starting) {
      sequence_.begin();
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
    if (next == SupervisorState::stopping) {
      if (is_interpolated_)
        axis_.stop_interpolated();
      else
        axis_.stop();
      stop_end_.begin();
    }
    if (!outputs_are_on(state_)) {
      is_interpolated_ = limiting_.velocity_limited = false;
      last_increment_ = 0;
      release_brake(false);
      axis_.disable();
    }
  }

  Hal& hal_;
  AxisMonitors<Scalar> monitors_;
  HomingSequence<Scalar> homing_;
  DriveSequence sequence_;
  IndexMonitor index_;
  std::int32_t until_index_ = 1;
  bool is_braking_ = false;
  InputFilter drive_fault_, drive_unready_, home_switch_;
  SupervisorState state_ = SupervisorState::off;
  SupervisorEvents requests_ = 0;
  AxisFault fault_ = AxisFault::none;
  AxisFault second_fault_ = AxisFault::none;
  bool is_fault_new_ = false;
  LimitingReasons limiting_{};
  bool is_interpolated_ = false;
  std::uint32_t fastest_ = 0, largest_change_ = 0;  ///< of a path's increments, upper words
  Increment last_increment_ = 0;
  Increment led_increment_ = 0;
  bool is_led_ = false;
  bool is_guided_ = false;  ///< led, or looking for home: the next step may be another one
  std::int32_t self_test_samples_ = 0;
  Standstill standstill_;
  StopEnd stop_end_;
  Axis<Scalar, Hal> axis_;  // the large tables come last: a load reaches no farther than 1 to 4 kB
  CaptureRing<Scalar> capture_;
};

}  // namespace firmware
