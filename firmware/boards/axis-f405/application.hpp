// The board and its program, which the control interrupt and the background share.
#pragma once

#include "firmware/app/board_application.hpp"
#include "firmware/app/liveness.hpp"
#include "firmware/boards/axis-f405/board.hpp"
#include "firmware/boards/image/board_scalar.hpp"

namespace firmware::boards {

using Application = BoardApplication<BoardScalar, Board>;

extern Board board;
extern Application application;
extern Liveness liveness;

}  // namespace firmware::boards
