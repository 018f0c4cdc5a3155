#include "host/device/motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "firmware/core/supervision/fault_table.hpp"
#include "firmware/core/supervision/supervisor_state.hpp"
#include "host/exit_codes.hpp"

namespace host {

namespace {

using firmware::SupervisorState;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

SupervisorState state_of(const BoardState& status, std::size_t axis) {
  return static_cast<SupervisorState>(status.axis.at(axis).state);
}

/// Requests the status, which also serves as heartbeat, until `done`.
template <typename Done>
bool ask_until(BoardClient& board, std::chrono::duration<double> patience, Done done) {
  const auto deadline = board.now() + patience;
  for (;;) {
    if (done(board.status())) return true;
    if (board.now() > deadline) return false;
    board.wait(kHeartbeat);
  }
}

template <typename Each>
bool for_all(std::uint8_t mask, Each each) {
  for (std::uint8_t axis = 0; mask >> axis != 0; ++axis)
    if ((mask >> axis & 1) != 0 && !each(axis)) return false;
  return true;
}

/// Throws if another program has taken control of the motion, which this program then must not end.
void require_own_motion(const BoardState& status) {
  if ((status.flags & firmware::kBoardOthers) != 0)
    throw Failure(ExitCode::refused, "another program has taken over the motion");
}

bool rests(const BoardState& status, std::uint8_t axis) {
  require_no_fault(status, axis);
  require_own_motion(status);
  return (status.axis.at(axis).flags & firmware::kAxisAtRest) != 0;
}

/// Has no time-out, because limits of acceleration may be low. Throws if the board does not answer.
void stop_and_wait(BoardClient& board, std::uint8_t axis) {
  board.stop();
  ask_until(board, std::chrono::hours(1), [&](const auto& status) { return rests(status, axis); });
}

/// Waits for a motion that ends by itself.
void wait_for_rest(BoardClient& board, std::uint8_t axis, const std::function<bool()>& stop) {
  bool interrupted = false;
  board.wait(kHeartbeat);  // the motion begins with the next control period
  ask_until(board, std::chrono::hours(24), [&](const auto& status) {
    interrupted = stop();
    return interrupted || rests(status, axis);
  });
  if (interrupted) stop_and_wait(board, axis);
}

/// Throws with the distance by which to move the switch, which the fault's own text cannot state: best is half a turn
/// before the pulse.
[[noreturn]] void refuse_switch(BoardClient& board, std::uint8_t axis) {
  const firmware::ParameterValues all = board.read_values();
  const firmware::AxisValues values = all.axis(axis);
  const auto row = board.fault_row(axis, 0);
  const double count = static_cast<double>(values.get<"drive.encoder_resolution">());
  const double spacing = count * values.get<"encoder.index_spacing">();
  const double turn = spacing > 0.0 ? spacing : static_cast<double>(values.get<"homing.index_travel">());
  const double way = count * (row ? row->index_way : 0);
  const double ahead = values.get<"homing.velocity">() < 0 ? -1.0 : 1.0;
  throw Failure(ExitCode::device_fault,
                fmt::format("axis {}: homing_index_near_switch: the index pulse is {:.4g} after the home switch, in a "
                            "turn of {:.4g}: the next homing may choose the next pulse. Remedy: move the switch by "
                            "{:+.4g} along the axis; then `axistool clear-faults`",
                            firmware::kAxisNames.at(axis), way, turn, ahead * (way - turn / 2.0)));
}

}  // namespace

void require_no_fault(const BoardState& status, std::uint8_t axis) {
  const std::uint8_t number = status.axis.at(axis).fault;
  if (number == 0) return;
  const firmware::FaultInfo& fault = firmware::fault_info(static_cast<firmware::AxisFault>(number));
  throw Failure(ExitCode::device_fault,
                fmt::format("axis {}: {}: {}. Remedy: {}; then `axistool clear-faults`", firmware::kAxisNames.at(axis),
                            fault.name, fault.cause, fault.remedy));
}

void enable_and_wait(BoardClient& board, std::uint8_t mask) {
  ask_until(board, std::chrono::seconds(2), [&](const auto& status) {
    return for_all(mask, [&](std::uint8_t axis) {
      require_no_fault(status, axis);
      return state_of(status, axis) != SupervisorState::self_test;
    });
  });
  // An axis that was just disabled may still coast.
  if (!ask_until(board, std::chrono::seconds(2), [&](const auto&) { return board.enable_at_rest(mask); }))
    board.enable(mask);
  // The longest times that the parameters of amplifier and brake allow, with some margin.
  const bool closed = ask_until(board, std::chrono::seconds(17), [&](const auto& status) {
    return for_all(mask, [&](std::uint8_t axis) {
      require_no_fault(status, axis);
      return state_of(status, axis) == SupervisorState::enabled;
    });
  });
  if (!closed)
    throw Failure(ExitCode::time_out, "the board does not enable the axis; `axistool doctor` checks further");
}

std::uint8_t enabled_axes(BoardClient& board, std::uint8_t mask) {
  const BoardState status = board.status();
  unsigned enabled = 0;
  for (unsigned axis = 0; mask >> axis != 0; ++axis)
    if ((mask >> axis & 1) != 0 && state_of(status, axis) == SupervisorState::enabled) enabled |= 1u << axis;
  return static_cast<std::uint8_t>(enabled);
}

bool are_enabled(BoardClient& board, std::uint8_t mask) { return enabled_axes(board, mask) == mask; }

void disable_and_wait(BoardClient& board, std::uint8_t mask) {
  board.disable(mask);
  const bool off = ask_until(board, std::chrono::minutes(1), [&](const auto& status) {
    return for_all(mask, [&](std::uint8_t axis) { return !firmware::outputs_are_on(state_of(status, axis)); });
  });
  if (!off) throw Failure(ExitCode::time_out, "the axis does not come to rest: press the emergency stop");
}

void require_reachable(const firmware::ParameterValues& values, std::uint8_t axis, double velocity) {
  const double limit = static_cast<double>(values.axis(axis).get<"limits.velocity">());
  constexpr double kRounding = 1.0 + 1e-6;  // rounding of the board's single precision
  if (std::abs(velocity) <= limit * kRounding) return;
  const char* name = firmware::kAxisNames.at(axis).data();
  throw Failure(ExitCode::refused, fmt::format("{:g} is beyond {}.limits.velocity = {:g}: jog at {:g} at most, or, if "
                                               "the machine may go faster, set {}.limits.velocity",
                                               velocity, name, limit, limit, name));
}

void require_no_contact(BoardClient& board, const firmware::ParameterValues& values) {
  if (values.get<"probe.input">() == 0 || (board.probe_state().flags & firmware::kProbeMet) == 0) return;
  throw Failure(ExitCode::answer_is_no, "the touch probe made contact, so all axes stopped; they may move away");
}

void jog_for(BoardClient& board, std::uint8_t axis, double velocity, std::chrono::duration<double> duration,
             const std::function<bool()>& stop) {
  board.jog(axis, velocity);
  bool has_moved = false;
  ask_until(board, duration, [&](const auto& status) {
    const bool is_at_rest = rests(status, axis);
    has_moved = has_moved || !is_at_rest;
    return stop() || (has_moved && is_at_rest);
  });
  stop_and_wait(board, axis);
}

void home_and_wait(BoardClient& board, std::uint8_t axis, const std::function<bool()>& stop) {
  board.home(axis, false);
  try {
    wait_for_rest(board, axis, stop);
  } catch (const Failure&) {
    constexpr auto kNear = static_cast<std::uint8_t>(firmware::AxisFault::homing_index_near_switch);
    if (board.status().axis.at(axis).fault == kNear) refuse_switch(board, axis);
    throw;
  }
}

std::int64_t counts_of(double length, const firmware::AxisValues& values) {
  const double counts = length / static_cast<double>(values.get<"drive.encoder_resolution">());
  if (!(std::abs(counts) <= 9e15))
    throw Failure(ExitCode::usage, fmt::format("{:g} is too far for the axis to count", length));
  return std::llround(counts);
}

bool is_long_without_limits(const firmware::AxisValues& values, double way) {
  const auto is_initial = [&](std::string_view name, float value) {
    return value == std::ranges::find(firmware::kParameters, name, &firmware::ParameterInfo::name)->initial;
  };
  return is_initial("monitor.travel_min", values.get<"monitor.travel_min">()) &&
         is_initial("monitor.travel_max", values.get<"monitor.travel_max">()) &&
         std::abs(way) > static_cast<double>(values.get<"homing.travel">());
}

void move_and_wait(BoardClient& board, std::uint8_t axis, std::int64_t counts, bool relative,
                   const std::function<bool()>& stop) {
  relative ? board.move_by(axis, counts) : board.move(axis, counts);
  wait_for_rest(board, axis, stop);
}

}  // namespace host
