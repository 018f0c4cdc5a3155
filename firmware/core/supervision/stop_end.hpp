// Decides when a stopping axis has come to rest.
#pragma once

#include <cstdint>

#include "firmware/core/motion/stopping_distance.hpp"
#include "firmware/core/supervision/standstill.hpp"

namespace firmware {

/// The reference is at rest, and the encoder's count has been constant for a while. The wait for an axis that
/// oscillates ends after kLongestSettling; the wait for a reference that does not come to rest, after twice its longest
/// ramp.
class StopEnd {
 public:
  static constexpr std::int32_t kLongestSettling = 200;  ///< samples that a stopped axis may take to come to rest

  constexpr void configure(const MotionLimits& limits) { longest_ = longest_ramp(limits) + kLongestSettling; }

  constexpr void begin() { settling_samples_ = standing_samples_ = samples_ = 0; }

  /// Call it in each sample after begin(). `is_held`: by a closed loop; an axis that nothing holds only needs to come
  /// to rest.
  constexpr bool has_stopped(bool reference_at_rest, bool is_held, std::int64_t counts) {
    if (++samples_ > longest_) return true;
    if (!is_held) settling_samples_ = 0;
    if (!reference_at_rest) {
      settling_samples_ = standing_samples_ = 0;
      return false;
    }
    const bool moves = counts != standing_at_;
    standing_at_ = counts;
    standing_samples_ = moves ? 0 : standing_samples_ + 1;
    return standing_samples_ >= Standstill::kSamples || ++settling_samples_ >= kLongestSettling;
  }

  /// From now on positions are counted from another origin.
  constexpr void shift(std::int64_t origin) { standing_at_ += origin; }

 private:
  std::int64_t standing_at_ = 0;
  std::int32_t settling_samples_ = 0, standing_samples_ = 0, samples_ = 0;
  std::int32_t longest_ = 0;
};

}  // namespace firmware
