// Boot code, the first code in flash: chooses the image, copies it to the program's place, and starts it.
// AXIS_BOOT_BOARD names the header of the board's folder; it declares firmware::boards::BootBoard.
#include <array>
#include <cstdint>

#include "firmware/app/update/boot_choice.hpp"
#include "hal/cortex_m/registers.hpp"

#include AXIS_BOOT_BOARD

extern "C" {
extern std::uint32_t _boot_stack_top[];  // NOLINT: a linker symbol
void boot_entry();
[[noreturn]] void boot_fault();
}

namespace {

using Handler = void (*)();

struct BootVectors {
  std::uint32_t* stack_top;
  std::array<Handler, 15> exceptions;
};

constexpr BootVectors make_boot_vectors() {
  BootVectors table{_boot_stack_top, {}};
  table.exceptions.fill(boot_fault);
  table.exceptions[0] = boot_entry;
  return table;
}

[[gnu::section(".vectors"), gnu::used]] constinit const BootVectors vectors = make_boot_vectors();

/// The program's reset handler does all further initialisation.
[[noreturn]] void start_program(std::uintptr_t vectors_of_program) {
  const auto* const entries = reinterpret_cast<const std::uint32_t*>(vectors_of_program);
  const std::uint32_t entry = entries[1];
  asm volatile("bx %0" : : "r"(entry));
  __builtin_unreachable();
}

}  // namespace

/// A fault restarts the board; the next start repeats an incomplete copy.
extern "C" [[gnu::used, noreturn]] void boot_fault() {
  hal::cortex_m::system_control().AIRCR = hal::cortex_m::SystemControl::kResetRequest;
  for (;;) asm volatile("" ::: "memory");
}

extern "C" [[gnu::used, noreturn]] void boot_program() {
  using firmware::boards::BootBoard;
  hal::cortex_m::system_control().VTOR = reinterpret_cast<std::uint32_t>(&vectors);
  BootBoard board;
  switch (firmware::BootChoice(board.image_flash()).prepare()) {
    case firmware::BootResult::nothing:
      break;
    case firmware::BootResult::on_trial:
      board.watch_trial();
      [[fallthrough]];
    case firmware::BootResult::program:
      start_program(BootBoard::kProgram);
  }
  for (;;) asm volatile("wfi" ::: "memory");  // nothing to start: outputs keep their safe state after reset
}

/// A boot ROM's loader may jump here with interrupts enabled and any stack.
extern "C" [[gnu::naked, gnu::used]] void boot_entry() {
  asm volatile(
      "cpsid i                   \n"
      "movs r0, #0               \n"
      "msr  control, r0          \n"
      "isb                       \n"
      "ldr  r0, =_boot_stack_top \n"
      "msr  msp, r0              \n"
      "bl   boot_program         \n"
      ".ltorg                    \n");
}
