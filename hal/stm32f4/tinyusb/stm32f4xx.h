// The parts of ST's header of this name that TinyUSB's driver for the STM32F4 needs; Debian does not have that header.
// Sections of RM0090 and, for the interrupt controller, of the ARMv7-M Architecture Reference Manual.
#pragma once

#include <stdint.h>

typedef enum { OTG_FS_IRQn = 67 } IRQn_Type;  // table 62

#define USB_OTG_FS_PERIPH_BASE 0x50000000u  // 2.3, table 1
#define USB_OTG_FS_MAX_IN_ENDPOINTS 4u      // 34.2: endpoint 0 and three more
#define USB_OTG_FS_TOTAL_FIFO_SIZE 1280u    // 34.2, bytes

/// The driver only checks whether the bus clock exceeds 32 MHz (34.16.2, TRDT).
static const uint32_t SystemCoreClock = 168000000u;

/// B3.4.4 and B3.4.5.
static inline void NVIC_EnableIRQ(IRQn_Type number) {
  ((volatile uint32_t*)0xE000E100u)[number / 32] = 1u << (number % 32);
}
static inline void NVIC_DisableIRQ(IRQn_Type number) {
  ((volatile uint32_t*)0xE000E180u)[number / 32] = 1u << (number % 32);
  __asm volatile("dsb\n isb" ::: "memory");
}

#define __NOP() __asm volatile("nop")
