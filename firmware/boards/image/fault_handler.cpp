#include "firmware/boards/image/fault_handler.hpp"

#include <cstdint>

#include "firmware/boards/image/survival_record.hpp"
#include "hal/cortex_m/registers.hpp"

extern "C" {
extern std::uint32_t _stack_guard[];  // NOLINT: linker symbols
extern std::uint32_t _stack_bottom[];
extern std::uint32_t _stack_top[];
extern std::uint32_t _image_start[];
}

namespace firmware::boards {

namespace {

constexpr std::uint32_t kStackGuardLog2 = 8;  // 256 bytes, as in sections.ld
constexpr std::uint32_t kNullLog2 = 20;       // 1 MB from address 0, where the STM32F405 has an alias of its flash
constexpr std::uint32_t kFrameWords = 8;      // r0-r3, r12, lr, pc, xpsr: ARMv7-M ARM, B1.5.6

bool in_guard(std::uint32_t address) {
  return address >= reinterpret_cast<std::uint32_t>(_stack_guard) &&
         address < reinterpret_cast<std::uint32_t>(_stack_bottom);
}

bool holds_frame(const std::uint32_t* stack) { return stack >= _stack_bottom && stack + kFrameWords <= _stack_top; }

}  // namespace

void arm_fault_detection() {
  using hal::cortex_m::Mpu;
  using hal::cortex_m::SystemControl;
#if __ARM_ARCH >= 7
  SystemControl& scb = hal::cortex_m::system_control();
  scb.SHCSR =
      scb.SHCSR | SystemControl::kMemManageEnable | SystemControl::kBusFaultEnable | SystemControl::kUsageFaultEnable;
  scb.CCR = scb.CCR | SystemControl::kTrapDivideByZero;
#endif
  Mpu& mpu = hal::cortex_m::mpu();
  mpu.RNR = 0;
  mpu.RBAR = reinterpret_cast<std::uint32_t>(_stack_guard);
  mpu.RASR = Mpu::size_field(kStackGuardLog2) | Mpu::kRegionEnable;
  // Detects reads through a null pointer, if no image lies at address 0.
  if (reinterpret_cast<std::uint32_t>(_image_start) >= 1u << kNullLog2) {
    mpu.RNR = 1;
    mpu.RBAR = 0;
    mpu.RASR = Mpu::size_field(kNullLog2) | Mpu::kRegionEnable;
  }
  mpu.CTRL = Mpu::kDefaultMapForPrivileged | Mpu::kEnable;
  asm volatile("dsb\n isb" ::: "memory");
}

void reset_processor() {
  survival_record().reset_requested = 1;
  asm volatile("dsb" ::: "memory");
  hal::cortex_m::system_control().AIRCR = hal::cortex_m::SystemControl::kResetRequest;
  for (;;) asm volatile("" ::: "memory");
}

}  // namespace firmware::boards

/// `stack`: the stack pointer at the fault; `callee`: r4 to r11. Runs on its own stack, because a full stack may be the
/// cause of the fault.
extern "C" [[gnu::used, noreturn]] void record_fault(const std::uint32_t* stack, const std::uint32_t* callee,
                                                     std::uint32_t exc_return) {
  using namespace firmware::boards;
  make_outputs_safe();
  const hal::cortex_m::SystemControl& scb = hal::cortex_m::system_control();
  SurvivalRecord& record = survival_record();
  FaultRecord& fault = record.fault;
  fault = FaultRecord{};
  fault.outputs_made_safe = 1;
  std::uint32_t exception = scb.ICSR & 0x1FF;
  if (exception > static_cast<std::uint32_t>(FaultKind::usage_fault)) {
    fault.unexpected_interrupt = exception;
    exception = static_cast<std::uint32_t>(FaultKind::hard_fault);
  }
  fault.kind = static_cast<FaultKind>(exception);
  for (std::uint32_t i = 0; i < 8; ++i) fault.r[4 + i] = callee[i];
  fault.sp = reinterpret_cast<std::uint32_t>(stack);
  fault.exc_return = exc_return;
#if __ARM_ARCH >= 7
  fault.cfsr = scb.CFSR;
  fault.hfsr = scb.HFSR;
  if ((fault.cfsr & scb.kMemManageAddressValid) != 0) fault.mmfar = scb.MMFAR;
  if ((fault.cfsr & scb.kBusAddressValid) != 0) fault.bfar = scb.BFAR;
  constexpr std::uint32_t kStackingFailed = (1u << 4) | (1u << 12);  // CFSR: MSTKERR, STKERR
  const bool stacked = (fault.cfsr & kStackingFailed) == 0;
#else
  const bool stacked = true;
#endif
  // An interrupt's frame that does not fit leaves no address (ARMv7-M ARM, B3.2.15).
  if (!stacked || stack < _stack_bottom || in_guard(fault.mmfar)) fault.stack_overflow = 1;
  if (stacked && holds_frame(stack)) {
    fault.frame_valid = 1;
    for (std::uint32_t i = 0; i < 4; ++i) fault.r[i] = stack[i];
    fault.r[12] = stack[4];
    fault.lr = stack[5];
    fault.pc = stack[6];
    fault.xpsr = stack[7];
  }
  fault.last = record.running;
  seal_fault();
  reset_processor();
}

/// Takes over from every fault exception. Thumb-1 only, so that it also serves parts without Thumb-2.
extern "C" [[gnu::naked, gnu::used]] void fault_entry() {
  asm volatile(
      "mrs  r0, msp          \n"
      "mov  r2, lr           \n"
      "ldr  r3, =_fault_stack_top \n"
      "mov  sp, r3           \n"
      "sub  sp, #32          \n"
      "mov  r1, sp           \n"
      "stmia r1!, {r4-r7}    \n"
      "mov  r4, r8           \n"
      "mov  r5, r9           \n"
      "mov  r6, r10          \n"
      "mov  r7, r11          \n"
      "stmia r1!, {r4-r7}    \n"
      "mov  r1, sp           \n"
      "bl   record_fault     \n"
      ".ltorg                \n");
}
