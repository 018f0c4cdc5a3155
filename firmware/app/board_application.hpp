// The firmware above the hardware: parameters, axes, capture, store; the same class on every board and on the PC.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "firmware/app/axis_status.hpp"
#include "firmware/app/board_limits.hpp"
#include "firmware/app/capture_stream.hpp"
#include "firmware/app/core_units.hpp"
#include "firmware/app/excitation_service.hpp"
#include "firmware/app/fault_log_service.hpp"
#include "firmware/app/limit_reply.hpp"
#include "firmware/app/motion_owner.hpp"
#include "firmware/app/parameters/parameter_change.hpp"
#include "firmware/app/parameters/parameter_check.hpp"
#include "firmware/app/parameters/set_crc.hpp"
#include "firmware/app/path_service.hpp"
#include "firmware/app/period_timing.hpp"
#include "firmware/app/protocol/messages.hpp"
#include "firmware/app/refusal_status.hpp"
#include "firmware/app/settings_watch.hpp"
#include "firmware/app/store/parameter_store.hpp"
#include "firmware/app/store/pitch_check.hpp"
#include "firmware/app/triggered_capture.hpp"
#include "firmware/core/supervision/axis_group.hpp"
#include "hal/board.hpp"

namespace firmware {

/// control_period() belongs to the control interrupt, everything else to the background.
template <typename Scalar, hal::Board Board>
class BoardApplication {
 public:
  using Number = Scalar;
  using BoardType = Board;
  using Axes = AxisGroup<Scalar, typename Board::AxisType, Board::kAxes>;
  using Flash = std::remove_reference_t<decltype(std::declval<Board&>().parameter_flash())>;
  using Store = ParameterStore<Flash>;
  static constexpr std::size_t kAxes = Board::kAxes;

  explicit BoardApplication(Board& board)
      : board_(board),
        store_(board.parameter_flash()),
        fault_log_(board.parameter_flash()),
        axes_([&board](std::size_t index) -> typename Board::AxisType& { return board.axis(index); }) {
    if constexpr (kBoardKeepsCapture)
      trigger_.adopt(board.capture_state(), board.capture_rows());
    else
      trigger_.adopt(own_memory_);
  }

  /// Call it before the control interrupt runs: loads the parameters from the store and configures the axes.
  void start() {
    store_.load(active_);
    fault_log_.start();
    saved_crc_ = active_crc_ = set_crc(active_);
    if (store_is_usable() && check_all(active_).kind != ValueRefusal::none) set_fits_ = false;
    configure_all();
  }

  void control_period() {
    const std::uint32_t now_us = board_.clock().now_us();
    if (excitation_.is_active()) excitation_.before_step(axes_);
    if (path_.is_moving()) path_.before_step();
    if (probe_.is_watching()) probe_.watch(path_);
    axes_.step({.now_us = now_us,
                .emergency_stop = board_.emergency_stop().is_pressed(),
                .supply_low = board_.supply().is_low(),
                .store_damaged = !store_is_usable(),
                .settings_changed = settings_.has_found()});
    if constexpr (requires { board_.power_relay(); }) board_.power_relay().close(axes_.may_have_power());
    capture_.take(axes_);
    if (trigger_.is_running()) trigger_.take(axes_);
    timing_.note(now_us, board_.clock().now_us());
    control_periods_ = control_periods_ + 1;
  }

  // Parameters. `staged` is the background's own copy; nothing acts before commit().
  const ParameterValues& active() const { return active_; }
  ParameterValues& staged() { return staged_; }
  bool has_unsaved_changes() const { return active_crc_ != saved_crc_; }

  /// Takes the staged set over, as a whole or not at all.
  Status commit(RefusedValuePayload& refused) {
    const std::size_t changed = change_that_needs_standstill(active_, staged_);
    if (changed < active_.size() && any_enabled()) {
      refused = {.key = key_at(changed).code, .bits = std::bit_cast<std::uint32_t>(staged_.at(changed))};
      return Status::drive_enabled;
    }
    const SetRefusal found = check_all(staged_);
    if (found.kind != ValueRefusal::none) {
      const std::size_t place = place_of(found.key).value_or(0);
      refused = {.key = found.key.code,
                 .kind = static_cast<std::uint8_t>(found.kind),
                 .bits = std::bit_cast<std::uint32_t>(staged_.at(place))};
      return Status::bad_value;
    }
    if (staged_ == active_) return Status::ok;
    std::array<bool, kAxes> displaced;
    for (std::size_t axis = 0; axis < kAxes; ++axis)
      displaced[axis] = do_counts_change_meaning(active_.axis(axis), staged_.axis(axis));
    active_ = staged_;
    active_crc_ = set_crc(active_);
    if (changed == active_.size() && set_fits_) {
      const BoardLimits limits = board_limits(active_);  // the only values that may change while an axis moves
      const typename Board::ControlShutOut guard;
      axes_.board().configure(limits);
      settings_.begin_anew();
      return Status::ok;
    }
    set_fits_ = true;
    configure_all();
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      const typename Board::ControlShutOut guard;
      if (displaced[axis]) axes_[axis].forget_home();
    }
    return Status::ok;
  }

  /// The control interrupt is stopped meanwhile: the outputs are off, and it could not run from stalled flash.
  Status save() {
    if (any_enabled()) return Status::drive_enabled;
    if (set_crc(active_) != active_crc_) return Status::device_fault;
    const bool was_usable = store_is_usable();
    const typename Board::ControlShutOut guard;
    const SaveResult result = while_stalled([this] { return store_.save(active_); });
    if (result == SaveResult::saved) saved_crc_ = active_crc_;
    if (was_usable)
      use_tables();
    else
      configure_all();
    return status_of(result);
  }

  /// Like save(), for a part of a table or an image. Only while no drive is enabled.
  template <typename Write>
  auto write_flash(Write write) {
    const typename Board::ControlShutOut guard;
    return while_stalled(write);
  }

  /// Assigns the staged table to the axis, switches it on or off, saves it with the parameters; no drive is enabled.
  Status finish_table(std::uint32_t crc, bool on) {
    if (set_crc(active_) != active_crc_) return Status::device_fault;
    staged_ = active_;
    staged_.set(*place_of(ParameterKey::of_axis(store_.staged_table().axis, pitch_check::kSwitch)), on ? 1.0F : 0.0F);
    const bool was_usable = store_is_usable();
    const SaveResult result = write_flash([&] { return store_.finish_table(staged_, crc); });
    if (result == SaveResult::saved) {
      active_ = staged_;
      saved_crc_ = active_crc_ = set_crc(active_);
    }
    if (result == SaveResult::saved || !was_usable) configure_all();
    return status_of(result);
  }

  Store& store() { return store_; }

  /// A set that is damaged, partly unknown, or refused by the control core keeps every drive disabled.
  bool store_is_usable() const {
    const StoreState state = store_.report().state;
    return set_fits_ && state != StoreState::damaged && state != StoreState::incomplete;
  }

  bool is_fitted(std::size_t axis) const { return active_.axis(axis).template get<"drive.fitted">(); }

  /// Enables all axes of the mask or none of them; `refused` is the axis that cannot be enabled.
  Status enable(unsigned mask, std::size_t& refused) {
    for (refused = 0; refused < Axes::kAxes; ++refused) {
      if ((mask >> refused & 1u) == 0) continue;
      if (!store_is_usable()) return Status::device_fault;
      if (!is_fitted(refused)) return Status::not_fitted;
    }
    const typename Board::ControlShutOut guard;
    refused = axes_.enable(mask);
    if (refused == Axes::kAxes) {
      axes_.board().host_heard();  // before the monitor of the next period
      axes_.board().forget_left_alone();
      return Status::ok;
    }
    return axes_[refused].state() == SupervisorState::ready ? Status::not_standing : refusal(refused);
  }

  /// A stop along the ramp; the enable drops at standstill. If the axis is on a path, all its axes stop on the path,
  /// and this one is disabled at the path's end.
  void disable(std::size_t axis) {
    if (path_.disables_at_end(axis)) return;
    const typename Board::ControlShutOut guard;
    axes_[axis].disable();
  }

  void stop() {
    path_.stop();
    const typename Board::ControlShutOut guard;
    excitation_.stop();
    for (std::size_t axis = 0; axis < kAxes; ++axis) axes_[axis].stop();
  }

  /// Velocity in mm/s (m/s).
  Status jog(std::size_t axis, float velocity) {
    if (!ScalarTraits<float>::is_finite(velocity)) return Status::malformed;
    const Scalar wanted = to_core_travel_velocity<Scalar>(velocity, active_.axis(axis));
    const bool needs_home = exceeds_unhomed_limit(velocity, active_.axis(axis));
    const typename Board::ControlShutOut guard;
    if (is_led(axis) || !guard_motion()) return Status::wrong_state;
    if (needs_home && !axes_[axis].is_homed()) return Status::bad_value;
    if (axes_[axis].state() == SupervisorState::enabled && !axes_[axis].has_room_towards(wanted))
      return Status::outside_travel;
    if (!axes_[axis].jog(wanted)) return refusal(axis);
    axes_.board().host_commands(true);
    return Status::ok;
  }

  /// Moves to a position (only a homed axis) or, if `relative`, by this many counts.
  Status move(std::size_t axis, std::int64_t counts, bool relative) {
    {
      const typename Board::ControlShutOut guard;
      if (axes_[axis].state() != SupervisorState::enabled || axes_.is_in_motion(axis) || is_led(axis))
        return refusal(axis);
      if (!relative && !axes_[axis].is_homed()) return Status::not_homed;
    }
    // At rest the reference is constant, and only this background code can change that.
    const MovePlanResult planned = relative ? axes_[axis].plan_move_by(counts, unhomed_share(active_.axis(axis)))
                                            : axes_[axis].plan_move_to(CountPosition::at(counts));
    if (planned.refusal != Refusal::none) return status_of(planned.refusal);
    const typename Board::ControlShutOut guard;
    if (!guard_motion() || !axes_[axis].start(planned.plan)) return refusal(axis);
    axes_.board().host_commands(true);
    return Status::ok;
  }

  // Excitation, of one axis at a time.
  Status load_excitation(const ExcitationEntriesRequest& request, ClientToken client) {
    if (excitation_.is_active()) return Status::wrong_state;
    return excitation_.load(request, client, active_.axis(request.axis), rate_Hz()) ? Status::ok : Status::malformed;
  }
  bool is_others_excitation(ClientToken client) const { return excitation_.is_others(client); }

  /// In open loop: for a disabled axis at rest, which needs no design (`refused`: the limit that applies without one).
  /// In closed loop: for an enabled axis at rest.
  Status excite(const ExcitationRequest& request, RefusedValuePayload& refused) {
    const std::size_t axis = request.axis;
    if (excitation_.is_active() || is_led(axis)) return Status::wrong_state;
    if (!excitation_.plan(request, active_.axis(axis), rate_Hz())) return Status::malformed;
    const typename Board::ControlShutOut guard;
    const SupervisorState state = axes_[axis].state();
    if (request.input != static_cast<std::uint8_t>(ExcitationInput::open_loop)) {
      if (state != SupervisorState::enabled || axes_.is_in_motion(axis)) return refusal(axis);
    } else {
      if (!store_is_usable() || state == SupervisorState::fault) return Status::device_fault;
      if (axes_[axis].is_or_will_be_on()) return Status::drive_enabled;
      if (!is_fitted(axis)) {
        if (exceeds_unfitted_limits(request, active_, refused)) return Status::bad_value;
        const float most = request.drive_velocity;
        const auto bare = bare_axis_parameters<Scalar>(active_.axis(axis), rate_Hz(), most / request.speed, most);
        if (axes_[axis].configure_bare(bare) != Refusal::none) return Status::malformed;
        settings_.begin_anew();
      }
    }
    excitation_.start();
    axes_.board().host_commands(true);
    return Status::ok;
  }

  void stop_excitation() {
    const typename Board::ControlShutOut guard;
    excitation_.stop();
  }
  ExcitationStatePayload excitation_state() const {
    const typename Board::ControlShutOut guard;
    return excitation_.state();
  }
  /// A path of enabled axes at rest. Its other functions are those of path().
  Status open_path(const OpenPathRequest& request, ClientToken client, OpenPathPayload& opened) {
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      if ((request.mask >> axis & 1u) == 0) continue;
      const typename Board::ControlShutOut guard;
      if (is_excited(axis) || axes_[axis].state() != SupervisorState::enabled || axes_.is_in_motion(axis))
        return refusal(axis);
    }
    return path_.open(request, client, probe_contact(active_), opened);
  }
  PathService<Axes, Board>& path() { return path_; }
  ProbeService<Axes, Board>& probe() { return probe_; }

  /// The limit of travel on one side of an axis.
  RefusedValuePayload limit_of_travel(std::size_t axis, bool positive) const {
    return positive ? limit_reply<"monitor.travel_max">(active_, axis)
                    : limit_reply<"monitor.travel_min">(active_, axis);
  }
  /// The side of an axis on which a target lies.
  bool is_ahead(std::size_t axis, std::int64_t target_counts) {
    const typename Board::ControlShutOut guard;
    return target_counts > axes_[axis].telemetry().encoder_counts;
  }

  /// Searches for home or, if `here`, sets the present position to homing.position, as homing.mode allows.
  Status home(std::size_t axis, bool here) {
    if (!is_fitted(axis)) return Status::not_fitted;
    const bool is_told = active_.axis(axis).template get<"homing.mode">() == static_cast<int>(HomingMode::none);
    if (here != is_told) return Status::homing_mode;
    if (excitation_.is_active() || is_led(axis)) return Status::wrong_state;
    const typename Board::ControlShutOut guard;
    if (here) return axes_[axis].set_position(axes_[axis].parameters().homing.position) ? Status::ok : refusal(axis);
    if (!guard_motion() || !axes_[axis].home()) return refusal(axis);
    axes_.board().host_commands(true);
    return Status::ok;
  }

  void clear_faults() {
    look_for_faults();
    fault_log_.forget();
    const typename Board::ControlShutOut guard;
    for (std::size_t axis = 0; axis < kAxes; ++axis) axes_[axis].clear_fault();
  }

  /// Call it once per round of the background. Like save(), it writes flash while the control interrupt is stopped.
  void keep_fault_log() {
    look_for_faults();
    if (!fault_log_.wants_flash() || any_enabled()) return;
    const typename Board::ControlShutOut guard;
    while_stalled([this] { return fault_log_.write(); });
  }
  /// Call it after start().
  void log_end_of_last_run(const LoggedFault& ended) { fault_log_.note(ended); }
  bool logged_fault(std::size_t age, FaultLogPayload& payload) { return fault_log_.read(age, payload); }

  bool is_in_motion() {
    const typename Board::ControlShutOut guard;
    return excitation_.is_active() || path_.is_moving() || axes_.is_in_motion();
  }
  // Ownership of motion. Every client may read, stop and disable.
  bool may_command(ClientToken client) { return owner_.may_command(client, is_in_motion()); }
  /// The client has commanded motion, or takes over the motion of another client.
  void become_owner(ClientToken client) {
    owner_.become(client);
    path_.take_over(client);
    owner_heard(client);
  }
  bool is_owner(ClientToken client) const { return owner_.is(client); }
  /// A request of the owner proves that the owner is alive; while every axis stands, it may be silent for longer.
  void owner_heard(ClientToken client) {
    if (!owner_.is(client)) return;
    const bool in_motion = is_in_motion();
    const typename Board::ControlShutOut guard;
    axes_.board().host_heard();
    if (!in_motion) axes_.board().host_commands(false);
  }

  void start_capture(const CaptureRequest& request) {
    const typename Board::ControlShutOut guard;
    capture_.start(request);
  }
  CaptureStream& capture() { return capture_; }

  /// A capture in the board's memory; `after` = 0 ends an armed capture.
  Status arm(const TriggerRequest& request) {
    if (request.after != 0 && !trigger_.is_possible(request, kAxes)) return Status::malformed;
    const typename Board::ControlShutOut guard;
    if (request.after == 0)
      trigger_.stop();
    else
      trigger_.arm(request);
    return Status::ok;
  }
  TriggerStatePayload trigger_state() const {
    const typename Board::ControlShutOut guard;
    return trigger_.state();
  }
  /// False beyond the end, and while rows are still being recorded.
  bool read_triggered(std::uint32_t first, TriggeredPayload& payload) const {
    const typename Board::ControlShutOut guard;
    return trigger_.read(first, payload);
  }

  /// The state of an axis at one instant.
  AxisStatus axis_status(std::size_t axis) const {
    AxisStatus status;
    Scalar velocity;
    {
      const typename Board::ControlShutOut guard;
      status = firmware::axis_status(axes_[axis], is_fitted(axis), active_.axis(axis).template get<"pitch.on">());
      velocity = axes_[axis].telemetry().estimate.velocity;
    }
    status.velocity = velocity_of_drive(axis, velocity);  // takes long, so the control interrupt runs again
    return status;
  }

  /// Whether any axis is enabled or about to be moved.
  bool any_enabled() const {
    for (std::size_t axis = 0; axis < kAxes; ++axis)
      if (axes_[axis].is_or_will_be_on()) return true;
    return excitation_.is_active();
  }
  std::uint32_t control_periods() const { return control_periods_; }
  TimingPayload timing() {
    const typename Board::ControlShutOut guard;
    return timing_.seen();
  }
  void begin_timing_anew() {
    const typename Board::ControlShutOut guard;
    timing_.begin_anew();
  }

  Board& board() { return board_; }
  Axes& axes() { return axes_; }
  SettingsWatch<Axes, Board>& settings() { return settings_; }

 private:
  static constexpr bool kBoardKeepsCapture = requires(Board & board) { board.capture_rows(); };

  float rate_Hz() const { return static_cast<float>(active_.template get<"control.rate">()); }
  bool is_excited(std::size_t axis) const { return excitation_.is_active() && excitation_.axis() == axis; }
  /// Whether an experiment or a path moves it.
  bool is_led(std::size_t axis) const { return is_excited(axis) || path_.leads(axis); }

  /// Call it with the control interrupt disabled, before a motion; false while axes slow down after a contact.
  bool guard_motion() { return probe_.begin_motion(probe_contact(active_)); }

  void look_for_faults() {
    fault_log_.look(axes_, control_periods_, static_cast<std::uint32_t>(rate_Hz()),
                    [this](std::size_t axis, Scalar velocity) { return velocity_of_drive(axis, velocity); });
  }

  template <typename Write>
  auto while_stalled(Write write) {
    board_.begin_stall();
    const auto result = write();
    board_.end_stall();
    axes_.board().excuse_pause();
    return result;
  }

  /// Only while no drive is enabled. The long part runs with the control interrupt enabled: SupervisedAxis::configure.
  void configure_all() {
    const BoardLimits limits = board_limits(active_);
    {
      const typename Board::ControlShutOut guard;
      board_.set_control_rate(static_cast<std::uint32_t>(active_.template get<"control.rate">()));
      axes_.board().configure(limits);
      axes_.board().excuse_pause();
      excitation_.forget();
    }
    settings_.begin_anew();
    if (!store_is_usable()) return;
    use_tables();
    for (std::size_t axis = 0; axis < kAxes; ++axis)
      if (is_fitted(axis))
        axes_[axis].template configure<typename Board::ControlShutOut>(axis_parameters<Scalar>(active_.axis(axis)));
  }

  void use_tables() {
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      const PitchTable points = store_.table(axis).points;
      const typename Board::ControlShutOut guard;
      axes_[axis].use_pitch_table(points);
    }
  }

  /// Checks values together with the stored tables.
  SetRefusal check_all(const ParameterValues& values) const {
    const SetRefusal found = check<Scalar>(values);
    return found.kind == ValueRefusal::none ? check_tables(values, store_) : found;
  }

  Status refusal(std::size_t axis) const {
    return axes_[axis].state() == SupervisorState::fault ? Status::device_fault : Status::wrong_state;
  }

  float velocity_of_drive(std::size_t axis, Scalar velocity) const {
    return from_core_velocity(velocity, active_.axis(axis));
  }

  Board& board_;
  Store store_;
  FaultLogService<Axes, Flash, typename Board::ControlShutOut> fault_log_;
  Axes axes_;
  CaptureStream capture_;
  TriggeredCapture trigger_;
  struct Nothing {};
  [[no_unique_address]] std::conditional_t<kBoardKeepsCapture, Nothing, TriggeredMemory> own_memory_{};
  ExcitationService<Scalar> excitation_;
  ProbeService<Axes, Board> probe_{axes_, board_};
  PathService<Axes, Board> path_{axes_, probe_};
  MotionOwner owner_;
  ParameterValues active_{kAxes};
  ParameterValues staged_{kAxes};
  std::uint32_t active_crc_ = 0, saved_crc_ = 0;  ///< a copy of the saved set would take more memory
  bool set_fits_ = true;
  SettingsWatch<Axes, Board> settings_{active_, axes_, board_};
  PeriodTiming timing_;
  volatile std::uint32_t control_periods_ = 0;  // written in the interrupt, read in the background
};

}  // namespace firmware
