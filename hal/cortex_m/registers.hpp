// Registers of the processor itself. Sections are those of the ARMv7-M Architecture Reference Manual (DDI 0403E).
#pragma once

#include <cstdint>

#include "hal/cortex_m/register.hpp"

namespace hal::cortex_m {

/// A peripheral's registers at their place in the address space.
template <typename Registers>
inline Registers& at_address(std::uintptr_t address) {
  return *reinterpret_cast<Registers*>(address);
}

/// System control block, B3.2.2.
struct SystemControl {
  Register CPUID, ICSR, VTOR, AIRCR, SCR, CCR, SHPR[3], SHCSR, CFSR, HFSR, DFSR, MMFAR, BFAR, AFSR;

  static constexpr std::uint32_t kForgetSysTick = 1u << 25;         // ICSR.PENDSTCLR, B3.2.4
  static constexpr std::uint32_t kResetRequest = 0x05FA0004;        // AIRCR: key and SYSRESETREQ, B3.2.6
  static constexpr std::uint32_t kTrapDivideByZero = 1u << 4;       // CCR, B3.2.8
  static constexpr std::uint32_t kTrapUnaligned = 1u << 3;          // CCR
  static constexpr std::uint32_t kMemManageEnable = 1u << 16;       // SHCSR, B3.2.13
  static constexpr std::uint32_t kBusFaultEnable = 1u << 17;        // SHCSR
  static constexpr std::uint32_t kUsageFaultEnable = 1u << 18;      // SHCSR
  static constexpr std::uint32_t kMemManageAddressValid = 1u << 7;  // CFSR, B3.2.15
  static constexpr std::uint32_t kBusAddressValid = 1u << 15;       // CFSR
};
inline SystemControl& system_control() { return at_address<SystemControl>(0xE000ED00); }

/// Coprocessor access, B3.2.20: full access to the FPU (CP10 and CP11).
inline Register& coprocessor_access() { return at_address<Register>(0xE000ED88); }
inline constexpr std::uint32_t kFpuFullAccess = 0xFu << 20;

/// SysTick, B3.3.
struct SysTick {
  Register CSR, RVR, CVR, CALIB;

  static constexpr std::uint32_t kEnable = 1u << 0;
  static constexpr std::uint32_t kInterrupt = 1u << 1;
  static constexpr std::uint32_t kProcessorClock = 1u << 2;
  static constexpr std::uint32_t kMostTicks = 1u << 24;
};
inline SysTick& sys_tick() { return at_address<SysTick>(0xE000E010); }

/// Memory protection unit, B3.5.
struct Mpu {
  Register TYPE, CTRL, RNR, RBAR, RASR;

  static constexpr std::uint32_t kEnable = 1u << 0;
  static constexpr std::uint32_t kDefaultMapForPrivileged = 1u << 2;  // CTRL
  static constexpr std::uint32_t kRegionEnable = 1u << 0;             // RASR; AP = 0: no access at all
  static constexpr std::uint32_t size_field(std::uint32_t log2_bytes) { return (log2_bytes - 1) << 1; }
};
inline Mpu& mpu() { return at_address<Mpu>(0xE000ED90); }

/// Cycle counter of the debug unit, C1.8: counts processor clocks modulo 2^32, while the trace unit is on (C1.6.5).
struct CycleCounter {
  Register CTRL, CYCCNT;

  static constexpr std::uint32_t kEnable = 1u << 0;
};
inline CycleCounter& cycle_counter() { return at_address<CycleCounter>(0xE0001000); }
inline Register& debug_monitor_control() { return at_address<Register>(0xE000EDFC); }
inline constexpr std::uint32_t kTraceEnable = 1u << 24;  // DEMCR.TRCENA

/// Interrupt controller, B3.4.
struct InterruptController {
  Register ISER[8];
  std::uint32_t reserved0[24];
  Register ICER[8];
  std::uint32_t reserved1[24];
  Register ISPR[8];
  std::uint32_t reserved2[24];
  Register ICPR[8];
  std::uint32_t reserved3[24];
  Register IABR[8];
  std::uint32_t reserved4[56];
  ByteRegister IPR[240];
};
inline InterruptController& interrupt_controller() { return at_address<InterruptController>(0xE000E100); }

/// `priority`: 0 is the most urgent; the chip implements the upper 4 of 8 bits (RM0090, section 12.1.1).
inline void set_interrupt_priority(std::uint32_t number, std::uint8_t priority) {
  interrupt_controller().IPR[number] = static_cast<std::uint8_t>(priority << 4);
}

inline void enable_interrupt(std::uint32_t number, std::uint8_t priority) {
  set_interrupt_priority(number, priority);
  interrupt_controller().ISER[number / 32] = 1u << (number % 32);
}

inline constexpr int kSysTickException = 15;

/// Priority of a system exception (4..15), B3.2.10.
inline void set_exception_priority(int exception, std::uint8_t priority) {
  at_address<ByteRegister>(0xE000ED18u + static_cast<std::uintptr_t>(exception) - 4) =
      static_cast<std::uint8_t>(priority << 4);
}

}  // namespace hal::cortex_m
