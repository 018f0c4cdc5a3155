// Backlash compensation: the reference crosses the gap when its direction changes, so that the table stays on the path.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/core/arithmetic/count_position.hpp"
#include "firmware/core/compensation/crossing_ramp.hpp"
#include "firmware/core/compensation/reversal_watch.hpp"
#include "firmware/core/control/reference_feedforward.hpp"

namespace firmware {

struct BacklashParameters {
  bool on = false;
  Increment gap = 0;                  ///< free travel of the table, 2^-48 counts; above 0, below 2^10 counts
  Increment wind_up = 0;              ///< twist behind the gap under friction, likewise; 0 or more
  std::int32_t crossing_samples = 1;  ///< 1..CrossingRamp::kLongest
};

/// Adds half the gap, and the twist that friction needs, on the side to which the reference moves.
class BacklashCrossing {
 public:
  constexpr void configure(const BacklashParameters& parameters) {
    parameters_ = parameters;
    ramp_.configure(parameters.crossing_samples);
    const Increment wind_up = parameters.wind_up >> 32;
    share_per_wind_up_ = wind_up > 0 ? (std::int64_t{1} << 46) / wind_up : 0;
    reset();
  }

  /// In the middle of the gap; for an axis whose position has just become known.
  constexpr void reset() {
    offsets_ = {};
    begin_ = target_ = 0;
    ramp_.end();
    reversal_.reset();
  }

  constexpr bool is_on() const { return parameters_.on; }
  constexpr bool is_crossing() const { return offsets_[kPreviewSamples] != target_ || offsets_[0] != target_; }

  /// What is added to the reference's newest increment.
  constexpr Increment next(Increment reference) {
    if (reversal_.turns(reference)) {
      begin_ = offsets_[kPreviewSamples];
      target_ = reversal_.side() * (parameters_.gap / 2 + parameters_.wind_up);
      ramp_.begin();
    }
    for (int i = 0; i < kPreviewSamples; ++i) offsets_[i] = offsets_[i + 1];
    if (ramp_.is_under_way()) offsets_[kPreviewSamples] = ramp_.next(begin_, target_);
    return offsets_[kPreviewSamples] - offsets_[kPreviewSamples - 1];
  }

  /// The friction of the table that reaches the motor in the period that begins, -1..1 of it with the sign of its
  /// effort: none inside the gap, all once the twist has built up.
  template <typename Scalar>
  constexpr Scalar carried() const {
    const Increment middle = offsets_[0] / 2 + offsets_[1] / 2;
    const Increment beyond = (middle < 0 ? -middle : middle) - parameters_.gap / 2;
    if (beyond <= 0) return Scalar(0);
    const Scalar side = middle < 0 ? Scalar(-1) : Scalar(1);
    if (beyond >= parameters_.wind_up) return side;
    const std::int64_t share = ((beyond >> 32) * share_per_wind_up_) >> 30;  // 2^-16
    return side * ScalarTraits<Scalar>::from_increment(share << (kFractionBits - 16));
  }

  /// What has been added to the reference `ahead` samples from now, 2^-48 counts.
  constexpr Increment offset(int ahead) const { return offsets_[ahead]; }
  /// Counts, rounded up, of the largest offset.
  constexpr std::int64_t largest_offset() const {
    return is_on() ? ((parameters_.gap / 2 + parameters_.wind_up) >> kFractionBits) + 1 : 0;
  }

 private:
  BacklashParameters parameters_{};
  std::int64_t share_per_wind_up_ = 0;  ///< 2^46 / wind_up, the latter in 2^-16 counts
  std::array<Increment, kPreviewSamples + 1> offsets_{};
  Increment begin_ = 0, target_ = 0;
  CrossingRamp ramp_;
  ReversalWatch reversal_;
};

}  // namespace firmware
