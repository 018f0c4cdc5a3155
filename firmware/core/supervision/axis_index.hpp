// Reads an axis's index pulses, for the monitor of its counts and for homing.
#pragma once

#include <cstdint>
#include <limits>

#include "firmware/core/supervision/index_monitor.hpp"

namespace firmware {

/// Reading the index clears its pulses, so it is read at most once per control period, and all users get that reading.
/// The monitor reads only every kSamples: index pulses are whole turns apart, however rarely they are read.
class AxisIndex {
 public:
  /// `spacing`: as of IndexMonitor.
  constexpr void configure(std::int32_t spacing) {
    monitor_.configure(spacing);
    until_ = 1;
  }
  constexpr void restart() { monitor_.restart(); }

  /// Call it once in each control period in which the index has not been read otherwise.
  constexpr bool is_due() { return --until_ <= 0; }

  /// Pulses since the last reading; `counter`: the encoder's, now.
  template <hal::IndexedEncoder Encoder>
  constexpr AxisFault look(Encoder& encoder, std::uint32_t counter) {
    until_ = monitor_.is_on() ? kSamples : std::numeric_limits<std::int32_t>::max();
    seen_ = encoder.read_index();
    return monitor_.is_on() ? monitor_.watch(seen_, counter) : AxisFault::none;
  }
  /// Result of the last reading.
  constexpr const hal::IndexReading& seen() const { return seen_; }

  // The axes of a group read in different control periods.
  constexpr bool has_just_looked() const { return until_ == kSamples; }
  constexpr void leave_for_later() { until_ = until_ <= 1 ? 2 : until_; }

 private:
  static constexpr std::int32_t kSamples = 16;

  IndexMonitor monitor_;
  hal::IndexReading seen_{};
  std::int32_t until_ = 1;
};

}  // namespace firmware
