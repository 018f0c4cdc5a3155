// One register of the chip: on the target a volatile word. In tests that emulate the chip (AXIS_REGISTERS_ANSWERED),
// each access goes to the test, with the address of the bus access.
#pragma once

#include <cstdint>
#ifdef AXIS_REGISTERS_ANSWERED
#include <type_traits>
#endif

namespace hal::cortex_m {

#ifdef AXIS_REGISTERS_ANSWERED

/// Defined by the test. `size` in bytes.
std::uint32_t answer_read(std::uintptr_t address, std::size_t size);
void answer_write(std::uintptr_t address, std::size_t size, std::uint32_t value);

/// Behaves as a volatile Word; the memory at its own address is never used.
template <typename Word>
class AnsweredRegister {
 public:
  AnsweredRegister() = default;
  AnsweredRegister(const AnsweredRegister&) = delete;

  // NOLINTBEGIN(misc-unconventional-assign-operator, bugprone-unhandled-self-assignment): as for a volatile Word
  void operator=(std::uint32_t value) { answer_write(address(), sizeof(Word), value); }
  void operator=(const AnsweredRegister& other) { *this = std::uint32_t{static_cast<Word>(other)}; }
  // NOLINTEND(misc-unconventional-assign-operator, bugprone-unhandled-self-assignment)
  // NOLINTNEXTLINE(google-explicit-constructor): a volatile converts by itself
  operator Word() const { return static_cast<Word>(answer_read(address(), sizeof(Word))); }

 private:
  std::uintptr_t address() const { return reinterpret_cast<std::uintptr_t>(this); }
  [[maybe_unused]] Word place_{};
};
using Register = AnsweredRegister<std::uint32_t>;
using ByteRegister = AnsweredRegister<std::uint8_t>;
static_assert(sizeof(Register) == 4 && sizeof(ByteRegister) == 1 && std::is_standard_layout_v<Register>);

#else

using Register = volatile std::uint32_t;
using ByteRegister = volatile std::uint8_t;

#endif

}  // namespace hal::cortex_m
