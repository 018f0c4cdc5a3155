// How many axes there are: said here, and nowhere else.
#pragma once

#include <cstddef>

namespace hal {

/// Of the axis board, and of what stands for it: PIL stations, the simulated machine. Another board says its own number
/// as Board::kAxes.
inline constexpr std::size_t kAxisCount = 2;

/// What names, keys and protocol have room for; a board of this family has 1 to that many.
inline constexpr std::size_t kMostAxes = 4;

}  // namespace hal
