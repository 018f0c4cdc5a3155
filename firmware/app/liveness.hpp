// Decides whether the watchdog may be fed: only if both the control interrupt and the supervisor have run.
#pragma once

#include <cstdint>

namespace firmware {

/// The control interrupt and the supervisor report; the background loop reads. Each counter has a single writer, so no
/// lock is needed.
class Liveness {
 public:
  void control_ran() { control_periods_ = control_periods_ + 1; }
  void supervisor_ran() { supervisor_rounds_ = supervisor_rounds_ + 1; }

  /// True if both have run since it last returned true.
  bool may_feed() {
    if (control_periods_ == fed_at_period_ || supervisor_rounds_ == fed_at_round_) return false;
    fed_at_period_ = control_periods_;
    fed_at_round_ = supervisor_rounds_;
    return true;
  }

  /// For the control interrupt: whether the supervisor has reported within the last kMostPeriods periods. Call it once
  /// a period.
  bool supervisor_ran_lately() {
    if (supervisor_rounds_ != seen_round_) {
      seen_round_ = supervisor_rounds_;
      seen_at_period_ = control_periods_;
    }
    return control_periods_ - seen_at_period_ <= kMostPeriods;
  }

  std::uint32_t control_periods() const { return control_periods_; }
  std::uint32_t supervisor_rounds() const { return supervisor_rounds_; }

 private:
  static constexpr std::uint32_t kMostPeriods = 200;  ///< 10 ms at 20 kHz; a round of the background takes 1 ms there

  volatile std::uint32_t control_periods_ = 0;    // written in the interrupt, read in the background
  volatile std::uint32_t supervisor_rounds_ = 0;  // written in the background, read in the interrupt
  std::uint32_t fed_at_period_ = 0;
  std::uint32_t fed_at_round_ = 0;
  std::uint32_t seen_round_ = 0;  // used by the interrupt only
  std::uint32_t seen_at_period_ = 0;
};

}  // namespace firmware
