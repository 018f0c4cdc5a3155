// Keeps every interrupt out for a moment.
#pragma once

#include <cstdint>

namespace hal::cortex_m {

/// While one lives no interrupt but faults and NMI runs; they nest.
class ControlShutOut {
 public:
  ControlShutOut() {
    asm volatile("mrs %0, primask" : "=r"(before_));
    asm volatile("cpsid i" ::: "memory");
  }
  ~ControlShutOut() { asm volatile("msr primask, %0" ::"r"(before_) : "memory"); }
  ControlShutOut(const ControlShutOut&) = delete;
  ControlShutOut& operator=(const ControlShutOut&) = delete;

 private:
  std::uint32_t before_ = 0;
};

}  // namespace hal::cortex_m
