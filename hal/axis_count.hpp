// Number of axes, defined only here.
#pragma once

#include <cstddef>

namespace hal {

/// Number of axes of the axis board and its substitutes: PIL stations, the simulated machine. Other boards define
/// Board::kAxes.
inline constexpr std::size_t kAxisCount = 2;

/// Largest number for names, keys and protocol; a board of this family has 1 to that many.
inline constexpr std::size_t kMostAxes = 4;

}  // namespace hal
