// Stack use of a run, from the remaining part of the pattern that start-up wrote.
#pragma once

#include <cstdint>

namespace firmware::boards {

/// Bytes below the top of the stack that have ever been written.
std::uint32_t stack_used_bytes();
std::uint32_t stack_size_bytes();

}  // namespace firmware::boards
