// The step of a position, determined from its values.
#pragma once

#include <vector>

namespace host {

/// The step of which all changes of a position are multiples, in the unit of the position; 0 if there is none. If the
/// axis mostly moves by hundreds of steps per row, it is the last digit of the text.
double position_grid(const std::vector<double>& position);

/// If the step of the positions exceeds that of the data sheet by this factor, they were quantised more coarsely. The
/// smallest possible factor is 2 (every second count); this value allows for the rounding of the text.
inline constexpr double kCoarser = 1.9;

}  // namespace host
