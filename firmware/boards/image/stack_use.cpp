#include "firmware/boards/image/stack_use.hpp"

extern "C" {
extern std::uint32_t _stack_bottom[];  // NOLINT: linker symbols
extern std::uint32_t _stack_top[];
}

namespace firmware::boards {

std::uint32_t stack_used_bytes() {
  constexpr std::uint32_t kStackPaint = 0xC5C5C5C5;  // the pattern that start-up writes
  const volatile std::uint32_t* word = _stack_bottom;
  while (word != _stack_top && *word == kStackPaint) ++word;
  return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(_stack_top) -
                                    reinterpret_cast<std::uintptr_t>(word));
}

std::uint32_t stack_size_bytes() {
  return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(_stack_top) -
                                    reinterpret_cast<std::uintptr_t>(_stack_bottom));
}

}  // namespace firmware::boards
