// Faults on purpose, to show that they are recorded.
#pragma once

#include <cstdint>

namespace firmware::boards {

/// Writes where nothing is.
inline void provoke_bus_fault() { *reinterpret_cast<volatile std::uint32_t*>(0xA0000000u) = 1; }

inline void provoke_division_by_zero() {
  volatile int zero = 0;
  volatile int result = 1;
  // cppcheck-suppress zerodiv; that is the purpose
  result = result / zero;
}

/// Calls itself until the stack has run into its guard.
[[gnu::noinline]] inline std::uint32_t provoke_stack_overflow(std::uint32_t depth = 0) {
  volatile std::uint32_t frame[32] = {depth};
  if (depth == UINT32_MAX) return frame[0];
  const std::uint32_t deeper = provoke_stack_overflow(depth + 1);
  return deeper + frame[depth % 32];
}

/// Asks for an interrupt that nothing here serves.
inline void provoke_unexpected_interrupt() {
  constexpr std::uint32_t kUnused = 50;
  *reinterpret_cast<volatile std::uint32_t*>(0xE000E100u + 4 * (kUnused / 32)) = 1u << (kUnused % 32);
  *reinterpret_cast<volatile std::uint32_t*>(0xE000E200u + 4 * (kUnused / 32)) = 1u << (kUnused % 32);
}

}  // namespace firmware::boards
