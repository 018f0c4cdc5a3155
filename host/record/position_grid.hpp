// The step of a position, as its own values show it.
#pragma once

#include <vector>

namespace host {

/// The step of which all changes of a position are multiples, in its unit; 0 where there is none. Where the axis mostly
/// moves by hundreds of steps a row, it is the last digit of the text.
double position_grid(const std::vector<double>& position);

/// Positions whose own step is larger than that of the data sheet by this have passed through something coarser: every
/// second count, the least that two whole numbers can differ by, less what digits of the text cost.
inline constexpr double kCoarser = 1.9;

}  // namespace host
