// The step of a position, determined from its values.
#pragma once

#include <vector>

namespace host {

/// The step of which all changes of a position are multiples, in the position's unit; 0 without a common step. If the
/// axis mostly moves by hundreds of steps per row, it is the last digit of the text.
double position_grid(const std::vector<double>& position);

/// If the positions' own step exceeds that of the data sheet by this factor, they have passed through a coarser
/// quantisation. The smallest possible factor is 2 (every second count); this is less, to allow for the rounding of the
/// text.
inline constexpr double kCoarser = 1.9;

}  // namespace host
