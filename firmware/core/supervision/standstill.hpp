// Whether an axis is at rest, by its encoder alone; and whether it has moved since its amplifier was enabled.
#pragma once

#include <cstdint>

namespace firmware {

class Standstill {
 public:
  static constexpr std::int32_t kSamples = 20;  ///< samples for which an axis must be at rest

  /// `play`: counts within which a closed loop holds its position (TravelMonitor), >= 2. An axis without a closed loop
  /// has an eighth of that: friction or the brake holds it, and it does not move.
  constexpr void configure(std::int64_t play) {
    play_ = play;
    slack_ = 2 + (play - 2) / 8;
  }

  /// The loop has opened here: what was seen before says nothing about the axis now.
  constexpr void restart(std::int64_t counts) {
    still_at_ = counts;
    samples_ = 0;
  }

  /// Call it in each sample of an open loop.
  constexpr void watch(std::int64_t counts) {
    if (samples_ < kSamples) ++samples_;
    if (is_within(counts, still_at_, play_)) return;
    still_at_ = counts;
    samples_ = 0;
  }
  constexpr bool stands() const { return samples_ >= kSamples; }

  /// The amplifier is being enabled.
  constexpr void begin_start(std::int64_t counts) { started_at_ = counts; }
  constexpr bool has_moved(std::int64_t counts) const { return !is_within(counts, started_at_, slack_); }

  /// From now on positions are counted from another origin.
  constexpr void shift(std::int64_t origin) {
    still_at_ += origin;
    started_at_ += origin;
  }

 private:
  static constexpr bool is_within(std::int64_t counts, std::int64_t place, std::int64_t play) {
    return counts - place <= play && place - counts <= play;
  }

  std::int64_t play_ = 2, slack_ = 2;
  std::int64_t still_at_ = 0, started_at_ = 0;
  std::int32_t samples_ = 0;
};

}  // namespace firmware
