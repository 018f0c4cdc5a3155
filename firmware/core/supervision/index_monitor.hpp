// Checks the encoder's counts between index pulses.
#pragma once

#include <cstdint>

#include "firmware/core/axis_fault.hpp"
#include "hal/encoder.hpp"

namespace firmware {

/// Every index pulse is a whole number of turns from the one before. The difference is summed from pulse to pulse, so
/// that single lost counts are found as well. More than a turn without a pulse indicates a dead index line, or a
/// counter that counts too much. Counts are the timer's, modulo 2^32.
class IndexMonitor {
 public:
  /// Tolerance in counts: a pulse is a few counts wide, and either of its edges may be captured.
  static constexpr std::int32_t kTolerance = 8;

  /// `spacing`: counts from one pulse to the next, >= 0; 0: not monitored.
  constexpr void configure(std::int32_t spacing) {
    spacing_ = spacing;
    restart();
  }
  constexpr bool is_on() const { return spacing_ != 0; }

  constexpr void restart() {
    is_begun_ = has_pulse_ = false;
    drift_ = 0;
  }

  /// Call it whenever the pulses are read, while on. `counts`: the present counter.
  constexpr AxisFault watch(const hal::IndexReading& index, std::uint32_t counts) {
    if (!is_begun_) last_ = counts;
    is_begun_ = true;
    if (index.seen) {
      if (has_pulse_) drift_ += beyond_whole_turns(static_cast<std::int32_t>(index.counts - last_));
      has_pulse_ = true;
      last_ = index.counts;
    }
    const auto since = static_cast<std::int32_t>(counts - last_);
    const std::int32_t longest = spacing_ + kTolerance;
    const bool is_missing = since > longest || since < -longest;
    const bool has_drifted = drift_ > kTolerance || drift_ < -kTolerance;
    return is_missing || has_drifted ? AxisFault::index_mismatch : AxisFault::none;
  }

 private:
  constexpr std::int32_t beyond_whole_turns(std::int32_t way) const {
    const std::int32_t rest = way % spacing_;
    const std::int32_t half = spacing_ / 2;
    return rest > half ? rest - spacing_ : (rest < -half ? rest + spacing_ : rest);
  }

  std::int32_t spacing_ = 0;
  std::int32_t drift_ = 0;
  std::uint32_t last_ = 0;  ///< of the last pulse; before the first pulse, of the monitor's start
  bool is_begun_ = false;
  bool has_pulse_ = false;
};

}  // namespace firmware
