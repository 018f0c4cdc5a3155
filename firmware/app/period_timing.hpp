// Measures the interval and the duration of control periods.
#pragma once

#include <algorithm>
#include <cstdint>

#include "firmware/app/protocol/messages.hpp"

namespace firmware {

/// For the control interrupt, or for the background while that is disabled.
class PeriodTiming {
 public:
  void note(std::uint32_t began_us, std::uint32_t ended_us) {
    if (seen_.periods > 0) {
      const std::uint32_t interval = began_us - last_us_;
      seen_.shortest_us = seen_.periods == 1 ? interval : std::min(seen_.shortest_us, interval);
      seen_.longest_us = std::max(seen_.longest_us, interval);
    }
    last_us_ = began_us;
    seen_.busiest_us = std::max(seen_.busiest_us, ended_us - began_us);
    seen_.periods = seen_.periods + 1;
  }
  const TimingPayload& seen() const { return seen_; }
  void begin_anew() { seen_ = {}; }

 private:
  TimingPayload seen_{};
  std::uint32_t last_us_ = 0;
};

}  // namespace firmware
