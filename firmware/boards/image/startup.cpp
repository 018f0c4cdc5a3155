// From reset to the board, and the vector table.
#include <array>
#include <cstdint>

#include "hal/cortex_m/registers.hpp"

// NOLINTBEGIN: names that the linker script gives
extern "C" {
extern std::uint32_t _data_start[], _data_end[], _data_load[];
extern std::uint32_t _ccm_start[], _ccm_end[], _ccm_load[];
extern std::uint32_t _bss_start[], _bss_end[];
extern std::uint32_t _stack_bottom[], _stack_top[];
extern void (*_init_array_start[])();
extern void (*_init_array_end[])();
[[noreturn]] void run_board();
void fault_entry();
void reset_entry();

void control_interrupt();
void usb_interrupt();
void adc_interrupt();
#ifdef AXIS_NMI_HANDLER
void AXIS_NMI_HANDLER();
#endif
#ifdef AXIS_TICK_HANDLER
void AXIS_TICK_HANDLER();
#endif
}
// NOLINTEND

namespace {

constexpr std::uint32_t kStackPaint = 0xC5C5C5C5;

void copy(const std::uint32_t* from, std::uint32_t* to, const std::uint32_t* end) {
  while (to != end) *to++ = *from++;
}

void fill(std::uint32_t* from, const std::uint32_t* end, std::uint32_t value) {
  while (from != end) *from++ = value;
}

/// Fills the stack below the caller's frame with a pattern, from which its deepest use can be read later.
void paint_stack() {
  std::uint32_t* here = nullptr;
  asm volatile("mov %0, sp" : "=r"(here));
  fill(_stack_bottom, here - 16, kStackPaint);
}

[[gnu::noinline, noreturn]] void start() {
  paint_stack();
  copy(_data_load, _data_start, _data_end);
  copy(_ccm_load, _ccm_start, _ccm_end);
  fill(_bss_start, _bss_end, 0);
  for (auto* initialiser = _init_array_start; initialiser != _init_array_end; ++initialiser) (*initialiser)();
  run_board();
}

}  // namespace

namespace {

using Handler = void (*)();

struct VectorTable {
  std::uint32_t* stack_top;
  std::array<Handler, 15> exceptions;
  std::array<Handler, AXIS_INTERRUPT_COUNT> interrupts;
};

constexpr VectorTable make_vectors() {
  VectorTable table{_stack_top, {}, {}};
  table.exceptions.fill(fault_entry);
  table.interrupts.fill(fault_entry);
  table.exceptions[0] = reset_entry;
#ifdef AXIS_CONTROL_INTERRUPT
  table.interrupts[AXIS_CONTROL_INTERRUPT] = control_interrupt;
#else
  table.exceptions[hal::cortex_m::kSysTickException - 1] = control_interrupt;
#endif
#ifdef AXIS_TICK_HANDLER
  table.exceptions[hal::cortex_m::kSysTickException - 1] = AXIS_TICK_HANDLER;
#endif
#ifdef AXIS_NMI_HANDLER
  table.exceptions[1] = AXIS_NMI_HANDLER;
#endif
#ifdef AXIS_ADC_INTERRUPT
  table.interrupts[AXIS_ADC_INTERRUPT] = adc_interrupt;
#endif
#ifdef AXIS_USB_INTERRUPT
  table.interrupts[AXIS_USB_INTERRUPT] = usb_interrupt;
#endif
  return table;
}

[[gnu::section(".vectors"), gnu::used]] constinit const VectorTable vectors = make_vectors();

}  // namespace

/// Restores the state after a reset: a boot ROM's loader starts a program with the loader's vector table, and with
/// enabled interrupts whose sources may still be active (AN3156: the program has to set the vector table itself).
extern "C" [[gnu::used, noreturn]] void begin_program() {
  using namespace hal::cortex_m;
  sys_tick().CSR = 0;
  system_control().ICSR = SystemControl::kForgetSysTick;
  InterruptController& interrupts = interrupt_controller();
  for (std::size_t word = 0; word < (AXIS_INTERRUPT_COUNT + 31) / 32; ++word) {
    interrupts.ICER[word] = 0xFFFFFFFF;
    interrupts.ICPR[word] = 0xFFFFFFFF;
  }
  system_control().VTOR = reinterpret_cast<std::uint32_t>(&vectors);
#if defined(__ARM_FP)
  coprocessor_access() = coprocessor_access() | kFpuFullAccess;  // start() may already use its registers
#endif
  asm volatile("dsb\n isb\n cpsie i" ::: "memory");
  start();
}

/// First disables interrupts and sets the main stack to its top. Thumb-1 only, so that it also serves parts without
/// Thumb-2.
extern "C" [[gnu::naked, gnu::used]] void reset_entry() {
  asm volatile(
      "cpsid i              \n"
      "movs r0, #0          \n"
      "msr  control, r0     \n"
      "isb                  \n"
      "ldr  r0, =_stack_top \n"
      "msr  msp, r0         \n"
      "bl   begin_program   \n"
      ".ltorg               \n");
}
