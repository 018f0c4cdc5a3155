// A smooth transition from one offset of the reference to another in a fixed time.
#pragma once

#include <cstdint>

#include "firmware/core/arithmetic/count_position.hpp"

namespace firmware {

/// The transition's speed rises and falls linearly.
class CrossingRamp {
 public:
  static constexpr std::int32_t kLongest = 4096;

  /// `samples`: 1..kLongest; any value if begin() is never called.
  constexpr void configure(std::int32_t samples) {
    samples_ = samples;
    const std::int64_t n = samples;
    area_per_square_ = n > 0 ? (std::int64_t{1} << 48) / (n * n) : 0;
    end();
  }

  constexpr void begin() { sample_ = 0; }
  constexpr void end() { sample_ = samples_; }
  constexpr bool is_under_way() const { return sample_ < samples_; }

  /// One sample farther between these two offsets, while the transition lasts. Either may change meanwhile.
  constexpr Increment next(Increment from, Increment to) {
    if (++sample_ >= samples_) return to;
    // The area under the triangle, in 2^-15 of the whole: 2 s^2 up to the middle, 1 - 2 (1 - s)^2 after it.
    const std::int32_t part = sample_ <= samples_ / 2 ? sample_ : samples_ - sample_;
    const auto area =
        static_cast<std::int32_t>((std::int64_t{part} * part * area_per_square_ + (std::int64_t{1} << 31)) >> 32);
    const std::int32_t share = sample_ <= samples_ / 2 ? area : 32768 - area;
    return from + ((to - from) >> 15) * share;
  }

 private:
  std::int64_t area_per_square_ = 0;  ///< 2^48 / n^2
  std::int32_t samples_ = 1, sample_ = 1;
};

}  // namespace firmware
