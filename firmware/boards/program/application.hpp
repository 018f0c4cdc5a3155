// A board and its program, which the control interrupt and the background share. AXIS_BOARD names the header of the
// board's folder; it declares firmware::boards::Board.
#pragma once

#include "firmware/app/board_application.hpp"
#include "firmware/app/liveness.hpp"
#include "firmware/boards/image/board_scalar.hpp"
#include "hal/cortex_m/cycle_meter.hpp"

#include AXIS_BOARD

namespace firmware::boards {

using Application = BoardApplication<BoardScalar, Board>;

extern Board board;
extern Application application;
extern Liveness liveness;
extern hal::cortex_m::CycleMeter control_cycles;  ///< of the control interrupt

}  // namespace firmware::boards
