// Commanded motion, with the heartbeat that a board asks for meanwhile.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>

#include "host/device/board_client.hpp"

namespace host {

/// How often a board is told that its host lives: a fifth of the silence that it suffers while an axis moves.
inline constexpr std::chrono::milliseconds kHeartbeat{20};

/// Enables the axes of `mask` and waits until their loops are closed, a self-test before included. Throws
/// Failure(device_fault, refused, time_out).
void enable_and_wait(BoardClient& board, std::uint8_t mask);

/// Whether all loops of the mask are closed.
bool are_enabled(BoardClient& board, std::uint8_t mask);

/// Slows down, drops the enables and waits until they are off.
void disable_and_wait(BoardClient& board, std::uint8_t mask);

/// Throws Failure(refused) naming the limit where `velocity` (mm/s or m/s) is beyond the axis's limits.velocity: the
/// board would go slower than it was told.
void require_reachable(const firmware::ParameterValues& values, std::uint8_t axis, double velocity);

/// Throws Failure(answer_is_no) where the last jog, move or homing ended because the touch probe met something.
void require_no_contact(BoardClient& board, const firmware::ParameterValues& values);

/// Jogs for a time, until the board ends it or until `stop` says so, then slows down to rest. Throws
/// Failure(device_fault) when the axis faults; whatever ends it, the axis is told to stop.
void jog_for(BoardClient& board, std::uint8_t axis, double velocity, std::chrono::duration<double> duration,
             const std::function<bool()>& stop);

/// Lets an enabled axis look for home and waits until it has found it, or until `stop` says so.
void home_and_wait(BoardClient& board, std::uint8_t axis, const std::function<bool()>& stop);

/// Moves to a target, or `relative` by so many counts, and waits until the axis rests there, or until `stop` says so.
void move_and_wait(BoardClient& board, std::uint8_t axis, std::int64_t counts, bool relative,
                   const std::function<bool()>& stop);

/// Throws Failure(device_fault) with the fault's name, cause and remedy.
void require_no_fault(const BoardState& status, std::uint8_t axis);

}  // namespace host
