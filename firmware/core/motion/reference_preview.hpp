// The reference as the control law sees it: now, and the two samples to come.
#pragma once

#include <array>

#include "firmware/core/arithmetic/count_position.hpp"
#include "firmware/core/control/reference_feedforward.hpp"

namespace firmware {

/// Delays the generated reference by kPreviewSamples, so that feed-forward may look ahead. The delay is the same
/// whether feed-forward uses it or not, and the same on every axis.
template <typename Scalar>
class ReferencePreview {
 public:
  /// `velocity_per_count`: rad/s (m/s) for one count a sample, dx / (lead Ts).
  constexpr void configure(Scalar velocity_per_count) { velocity_per_count_ = velocity_per_count; }

  constexpr void reset(const CountPosition& position) {
    position_ = position;
    increments_ = {};
    velocities_ = {};
  }

  /// Takes the newest increment of the reference; the one from kPreviewSamples ago becomes the present one.
  constexpr void push(Increment newest) {
    for (int i = 0; i < kPreviewSamples; ++i) {
      increments_[i] = increments_[i + 1];
      velocities_[i] = velocities_[i + 1];
    }
    increments_[kPreviewSamples] = newest;
    velocities_[kPreviewSamples] = ScalarTraits<Scalar>::from_increment(newest) * velocity_per_count_;
    position_.advance(increments_[0]);
  }

  /// The same position, counted from another origin.
  constexpr void shift(std::int64_t counts) { position_.counts += counts; }

  constexpr const CountPosition& position() const { return position_; }  ///< xref(k)
  /// xref(k + kPreviewSamples)
  constexpr CountPosition leading() const {
    CountPosition leading = position_;
    for (int i = 1; i <= kPreviewSamples; ++i) leading.advance(increments_[i]);
    return leading;
  }
  /// Midway between xref(k) and xref(k+1).
  constexpr CountPosition halfway() const {
    CountPosition middle = position_;
    middle.advance(increments_[1] >> 1);
    return middle;
  }
  constexpr Increment newest() const { return increments_[kPreviewSamples]; }  ///< of leading() in the last sample
  /// wref(k + ahead) by eq. (52), rad/s (m/s), 0 <= ahead <= kPreviewSamples.
  constexpr Scalar velocity(int ahead) const { return velocities_[ahead]; }
  constexpr Scalar weighted_sum(const ReferenceFeedforward<Scalar>& feedforward) const {
    Scalar sum = feedforward.velocity * velocities_[0];
    for (int i = 0; i < kPreviewSamples; ++i) sum = sum + feedforward.change[i] * (velocities_[i + 1] - velocities_[i]);
    return sum;
  }

 private:
  CountPosition position_{};
  std::array<Increment, kPreviewSamples + 1> increments_{};
  std::array<Scalar, kPreviewSamples + 1> velocities_{};
  Scalar velocity_per_count_{};
};

}  // namespace firmware
