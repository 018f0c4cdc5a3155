// Limits of a planned path: number of nodes and duration.
#pragma once

#include <cstddef>

namespace host {

/// Throws Failure(bad_input) naming the line and the limit. With slow axes even a short program may last for days.
void require_bounded(std::size_t nodes, double duration_s, std::size_t line);

}  // namespace host
