// Deliberate faults, to test that they are recorded.
#pragma once

#include <cstdint>

#include "hal/cortex_m/registers.hpp"

namespace firmware::boards {

/// Writes to an address without memory.
inline void provoke_bus_fault() { *reinterpret_cast<volatile std::uint32_t*>(0xA0000000u) = 1; }

/// Reads a member through a null pointer.
inline void provoke_null_read() {
  volatile std::uintptr_t null = 0;
  static_cast<void>(*reinterpret_cast<volatile std::uint32_t*>(null + 8));
}

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

/// Requests an interrupt without a handler.
inline void provoke_unexpected_interrupt() {
  constexpr std::uint32_t kUnused = 24;
  *reinterpret_cast<volatile std::uint32_t*>(0xE000E100u + 4 * (kUnused / 32)) = 1u << (kUnused % 32);
  *reinterpret_cast<volatile std::uint32_t*>(0xE000E200u + 4 * (kUnused / 32)) = 1u << (kUnused % 32);
}

/// Starts the program again as a boot ROM's loader does, without a reset: the vector table is the loader's, whose
/// handlers know nothing of this program, and interrupts of its own are enabled and pending.
[[noreturn]] inline void start_again_like_a_boot_rom() {
  using namespace hal::cortex_m;
  constexpr std::uint32_t kVectors = 128, kPlace = 0x2001F000;  // where no image has data
  constexpr std::uint32_t kPending = 25;
  auto* table = reinterpret_cast<std::uint32_t*>(kPlace);
  std::uint16_t* endless = reinterpret_cast<std::uint16_t*>(kPlace + 4 * kVectors);
  *endless = 0xE7FE;  // b .
  asm volatile("cpsid i" ::: "memory");
  for (std::uint32_t i = 0; i < kVectors; ++i) table[i] = reinterpret_cast<std::uint32_t>(endless) | 1;
  const auto* program = reinterpret_cast<const std::uint32_t*>(static_cast<std::uintptr_t>(system_control().VTOR));
  const std::uint32_t entry = program[1];
  system_control().VTOR = kPlace;
  interrupt_controller().ISPR[kPending / 32] = 1u << (kPending % 32);
  interrupt_controller().ISER[kPending / 32] = 1u << (kPending % 32);
  asm volatile(
      "dsb \n isb \n"
      "msr msp, %0 \n"
      "bx %1" ::"r"(kPlace),
      "r"(entry)
      : "memory");
  __builtin_unreachable();
}

}  // namespace firmware::boards
