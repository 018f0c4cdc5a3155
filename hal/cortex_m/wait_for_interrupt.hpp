// Puts the processor to sleep.
#pragma once

namespace hal::cortex_m {

/// Returns after an interrupt has run (ARMv7-M Architecture Reference Manual, A7.7.262).
inline void wait_for_interrupt() { asm volatile("wfi" ::: "memory"); }

}  // namespace hal::cortex_m
