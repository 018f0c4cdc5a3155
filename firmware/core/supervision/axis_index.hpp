// The one reader of an axis's index pulses, for the monitor of its counts and for homing.
#pragma once

#include <cstdint>
#include <limits>

#include "firmware/core/supervision/index_monitor.hpp"

namespace firmware {

/// Reading the index clears its pulses, so it is read at most once per control period, and all users get that reading.
/// The monitor alone looks every kSamples: index pulses are whole turns apart however seldom they are asked for.
class AxisIndex {
 public:
  /// `spacing`: as of IndexMonitor.
  constexpr void configure(std::int32_t spacing) {
    monitor_.configure(spacing);
    until_ = 1;
  }
  constexpr void restart() { monitor_.restart(); }

  /// Once a control period in which nobody else has looked.
  constexpr bool is_due() { return --until_ <= 0; }

  /// Pulses since the last reading; `counter`: the encoder's, now.
  template <hal::IndexedEncoder Encoder>
  constexpr AxisFault look(Encoder& encoder, std::uint32_t counter) {
    until_ = monitor_.is_on() ? kSamples : std::numeric_limits<std::int32_t>::max();
    seen_ = encoder.read_index();
    return monitor_.is_on() ? monitor_.watch(seen_, counter) : AxisFault::none;
  }
  /// Of the last look.
  constexpr const hal::IndexReading& seen() const { return seen_; }

  // Axes of a group look in control periods of their own.
  constexpr bool has_just_looked() const { return until_ == kSamples; }
  constexpr void leave_for_later() { until_ = until_ <= 1 ? 2 : until_; }

 private:
  static constexpr std::int32_t kSamples = 16;

  IndexMonitor monitor_;
  hal::IndexReading seen_{};
  std::int32_t until_ = 1;
};

}  // namespace firmware
