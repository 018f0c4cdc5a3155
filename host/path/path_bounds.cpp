#include "host/path/path_bounds.hpp"

#include <fmt/format.h>

#include "host/exit_codes.hpp"
#include "host/input_limits.hpp"

namespace host {

void require_bounded(std::size_t nodes, double duration_s, std::size_t line) {
  if (!(duration_s <= kLongestPath_s))
    throw Failure(ExitCode::bad_input,
                  fmt::format("line {}: within the axes' limits the program lasts longer than {:g} h: raise these "
                              "limits or split the program",
                              line, kLongestPath_s / 3600.0));
  if (nodes > kMostPathNodes)
    throw Failure(ExitCode::bad_input, fmt::format("line {}: the program has more than {} nodes, the limit: split it",
                                                   line, kMostPathNodes));
}

}  // namespace host
