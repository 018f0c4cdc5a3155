// Backlash compensation: the reference crosses the gap when its direction changes, so that the table stays on the path.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/core/arithmetic/count_position.hpp"
#include "firmware/core/control/reference_feedforward.hpp"

namespace firmware {

struct BacklashParameters {
  bool on = false;
  Increment gap = 0;                  ///< free travel of the table, 2^-48 counts; above 0, below 2^10 counts
  Increment wind_up = 0;              ///< twist behind the gap under friction, likewise; 0 or more
  std::int32_t crossing_samples = 1;  ///< 1..kLongestCrossing
};

/// Adds half the gap, and the twist that friction needs, on the side to which the reference moves. The way across takes
/// a fixed number of samples, with a speed that rises and falls in a straight line.
class BacklashCrossing {
 public:
  static constexpr std::int32_t kLongestCrossing = 4096;

  constexpr void configure(const BacklashParameters& parameters) {
    parameters_ = parameters;
    const std::int64_t n = parameters.crossing_samples;
    area_per_square_ = n > 0 ? (std::int64_t{1} << 48) / (n * n) : 0;  // switched off, it is not checked
    const Increment wind_up = parameters.wind_up >> 32;
    share_per_wind_up_ = wind_up > 0 ? (std::int64_t{1} << 46) / wind_up : 0;
    reset();
  }

  /// In the middle of the gap; for an axis whose position has just become known.
  constexpr void reset() {
    offsets_ = {};
    begin_ = target_ = back_ = 0;
    sample_ = parameters_.crossing_samples;
    side_ = 0;
  }

  constexpr bool is_on() const { return parameters_.on; }
  constexpr bool is_crossing() const { return offsets_[kPreviewSamples] != target_ || offsets_[0] != target_; }

  /// What is added to the reference's newest increment.
  constexpr Increment next(Increment reference) {
    watch_direction(reference);
    for (int i = 0; i < kPreviewSamples; ++i) offsets_[i] = offsets_[i + 1];
    if (sample_ < parameters_.crossing_samples) offsets_[kPreviewSamples] = place_after(++sample_);
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

 private:
  /// A reference at rest may dither by its rounding: that is no reversal.
  static constexpr Increment kReversal = kOneCount / 16;

  constexpr void watch_direction(Increment reference) {
    const int direction = reference > 0 ? 1 : (reference < 0 ? -1 : side_);
    if (direction == side_) {
      if (reference != 0) back_ = 0;
      return;
    }
    back_ += reference;
    if (back_ < kReversal && back_ > -kReversal) return;
    side_ = direction;
    back_ = 0;
    begin_ = offsets_[kPreviewSamples];
    target_ = side_ * (parameters_.gap / 2 + parameters_.wind_up);
    sample_ = 0;
  }

  constexpr Increment place_after(std::int32_t sample) const {
    const std::int32_t n = parameters_.crossing_samples;
    if (sample == n) return target_;
    // The area under the triangle, in 2^-15 of the whole: 2 s^2 up to the middle, 1 - 2 (1 - s)^2 after it.
    const std::int32_t part = sample <= n / 2 ? sample : n - sample;
    const auto area =
        static_cast<std::int32_t>((std::int64_t{part} * part * area_per_square_ + (std::int64_t{1} << 31)) >> 32);
    const std::int32_t share = sample <= n / 2 ? area : 32768 - area;
    return begin_ + ((target_ - begin_) >> 15) * share;
  }

  BacklashParameters parameters_{};
  std::int64_t area_per_square_ = 0;    ///< 2^48 / n^2
  std::int64_t share_per_wind_up_ = 0;  ///< 2^46 / wind_up, the latter in 2^-16 counts
  std::array<Increment, kPreviewSamples + 1> offsets_{};
  Increment begin_ = 0, target_ = 0, back_ = 0;
  std::int32_t sample_ = 1;
  int side_ = 0;
};

}  // namespace firmware
