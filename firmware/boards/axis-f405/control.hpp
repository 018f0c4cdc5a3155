// The two axes of the board: what the background may ask of them while the control interrupt runs them.
#pragma once

#include <cstddef>

#include "firmware/boards/axis-f405/board.hpp"
#include "firmware/boards/image/board_scalar.hpp"
#include "firmware/core/supervision/axis_group.hpp"

namespace firmware::boards {

inline constexpr std::size_t kAxes = 2;
inline constexpr float kControlPeriod_s = 0.001f;

/// The board behind both axes; started by whoever starts the program.
Board& board();

// Each of these shuts the control interrupt out for a few microseconds. `axis` is 0 or 1; results as of Axis.
ParameterError configure_axis(std::size_t axis, const AxisParameters<BoardScalar>& parameters);
bool enable_axis(std::size_t axis);
bool disable_axis(std::size_t axis);  ///< slows down first
bool jog_axis(std::size_t axis, BoardScalar velocity);
void stop_axis(std::size_t axis);
bool clear_axis_fault(std::size_t axis);
SupervisorState axis_state(std::size_t axis);
AxisFault axis_fault(std::size_t axis);
AxisTelemetry<BoardScalar> axis_telemetry(std::size_t axis);

/// While the host commands motion it must be heard from at least every 0.1 s, or both axes stop.
void host_commands_motion(bool commands);
void host_heard();

/// From now on no axis leaves its self-test.
void report_damaged_store();

/// Plans in the background, starts at the next control period. Refused while the axis is disabled or moves.
bool move_axis(std::size_t axis, std::int64_t target_counts);

/// One control period of both axes; for the control interrupt alone.
void control_period();

}  // namespace firmware::boards
