// Commanded motion, with the heartbeat that a board requires during it.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>

#include "firmware/app/parameters/parameter_values.hpp"
#include "host/device/board_client.hpp"

namespace host {

/// Interval of heartbeats: a fifth of the board's heartbeat time-out while an axis moves.
inline constexpr std::chrono::milliseconds kHeartbeat{20};

/// Enables the axes of `mask` and waits until their loops are closed, including a self-test before. Throws
/// Failure(device_fault, refused, time_out).
void enable_and_wait(BoardClient& board, std::uint8_t mask);

/// The axes of the mask whose loops are closed.
std::uint8_t enabled_axes(BoardClient& board, std::uint8_t mask);

/// Whether all loops of the mask are closed.
bool are_enabled(BoardClient& board, std::uint8_t mask);

/// Slows the axes down, disables them and waits until they are off.
void disable_and_wait(BoardClient& board, std::uint8_t mask);

/// Throws Failure(refused) if `velocity` (mm/s or m/s) exceeds the axis's limits.velocity, because the board would move
/// more slowly than commanded.
void require_reachable(const firmware::ParameterValues& values, std::uint8_t axis, double velocity);

/// Counts of a length, mm or m. Throws Failure(usage) if the axis cannot count as far.
std::int64_t counts_of(double length, const firmware::AxisValues& values);

/// Whether a move by `way`, mm or m, is longer than homing.travel although the travel limits have their initial values,
/// because these are not the real limits.
bool is_long_without_limits(const firmware::AxisValues& values, double way);

/// Throws Failure(answer_is_no) if the last jog, move or homing ended because the touch probe made contact.
void require_no_contact(BoardClient& board, const firmware::ParameterValues& values);

/// Jogs for a time, until the board ends it or until `stop` returns true, then slows down to rest. Throws
/// Failure(device_fault) if the axis has a fault. However it ends, the axis is stopped.
void jog_for(BoardClient& board, std::uint8_t axis, double velocity, std::chrono::duration<double> duration,
             const std::function<bool()>& stop);

/// Homes an enabled axis and waits until home is found, or until `stop` returns true.
void home_and_wait(BoardClient& board, std::uint8_t axis, const std::function<bool()>& stop);

/// Moves to a target, or if `relative` by this many counts, and waits until the axis rests there, or until `stop`
/// returns true.
void move_and_wait(BoardClient& board, std::uint8_t axis, std::int64_t counts, bool relative,
                   const std::function<bool()>& stop);

/// Throws Failure(device_fault) with the fault's name, cause and remedy.
void require_no_fault(const BoardState& status, std::uint8_t axis);

}  // namespace host
