// Measures processor clocks with the debug unit's counter, including wait states and caches.
#pragma once

#include "hal/cortex_m/registers.hpp"

namespace hal::cortex_m {

/// Call `begin` and `end` in one interrupt; another priority may read the results.
class CycleMeter {
 public:
  /// The counter does not run until the trace unit is on (ARMv7-M ARM, C1.6.5).
  void start() {
    debug_monitor_control() = debug_monitor_control() | kTraceEnable;
    cycle_counter().CYCCNT = 0;
    cycle_counter().CTRL = cycle_counter().CTRL | CycleCounter::kEnable;
  }

  void begin() { began_at_ = cycle_counter().CYCCNT; }

  void end() {
    const std::uint32_t taken = cycle_counter().CYCCNT - began_at_;
    if (taken > worst_) worst_ = taken;
    average_times_256_ = average_times_256_ + taken - average_times_256_ / kWeight;
  }

  /// Average over some 256 measurements.
  std::uint32_t average() const { return average_times_256_ / kWeight; }
  std::uint32_t worst() const { return worst_; }

 private:
  static constexpr std::uint32_t kWeight = 256;

  std::uint32_t began_at_ = 0;
  volatile std::uint32_t average_times_256_ = 0;  // written in the interrupt, read in the background
  volatile std::uint32_t worst_ = 0;
};

}  // namespace hal::cortex_m
