// Disables all interrupts for a short time.
#pragma once

#include <cstdint>

namespace hal::cortex_m {

#ifdef AXIS_REGISTERS_ANSWERED
/// For tests; see register.hpp.
void answer_shut_out(bool begins);
#endif

/// While an object exists, no interrupt except faults and NMI runs; objects nest.
class ControlShutOut {
 public:
#ifdef AXIS_REGISTERS_ANSWERED
  ControlShutOut() { answer_shut_out(true); }
  ~ControlShutOut() { answer_shut_out(false); }
#else
  ControlShutOut() {
    asm volatile("mrs %0, primask" : "=r"(before_));
    asm volatile("cpsid i" ::: "memory");
  }
  ~ControlShutOut() { asm volatile("msr primask, %0" ::"r"(before_) : "memory"); }
#endif
  ControlShutOut(const ControlShutOut&) = delete;
  ControlShutOut& operator=(const ControlShutOut&) = delete;

 private:
  [[maybe_unused]] std::uint32_t before_ = 0;
};

}  // namespace hal::cortex_m
