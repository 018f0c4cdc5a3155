// Monitors the drive after the enable has dropped: the amplifier must report it, and the drive must not gain speed.
#pragma once

#include <cstdint>

#include "firmware/core/axis_parameters.hpp"

namespace firmware {

/// Otherwise the amplifier still drives: its enable relay is welded or bypassed, and only its power can be cut. A ready
/// contact must open within kTime_s and stay open. The speed must not grow for kTime_s, counted after the brake's time
/// to hold (until then a loaded vertical axis falls), and must never exceed the overspeed limit.
template <typename Scalar>
class DropWatch {
 public:
  static constexpr float kTime_s = 0.1f;

  constexpr void configure(const AxisParameters<Scalar>& p) {
    const Scalar share = p.monitors.load_share * Scalar(kLoadTime_s / kTime_s);
    while_samples_ = 1;
    for (Scalar sum = share; sum < Scalar(1) && while_samples_ < kMostSamples; sum = sum + share) ++while_samples_;
    brake_samples_ = p.sequence.brake_fitted ? p.sequence.brake_application : 0;
    velocity_ = Scalar(0);
    left_ = ready_samples_ = 0;
  }

  /// Called when the enable drops.
  constexpr void begin() { left_ = brake_samples_ + while_samples_; }

  /// Called in each sample without an enable. `velocity`: from the slower sensor. The speed may grow by twice the
  /// difference that is allowed between the sensors.
  constexpr bool is_driven(const MonitorLimits<Scalar>& limits, bool says_ready, Scalar velocity) {
    if (left_ == brake_samples_ + while_samples_) velocity_ = velocity;
    velocity_ = velocity_ + (velocity - velocity_) * Scalar(1.0f / kFilterSamples);
    const Scalar speed = ScalarTraits<Scalar>::magnitude(velocity_);
    if (left_ > 0) --left_;
    if (left_ >= while_samples_ - kFilterSamples) most_ = speed + limits.disagreement_floor * Scalar(2);
    if (ready_samples_ <= while_samples_) ++ready_samples_;
    if (!says_ready) ready_samples_ = 0;
    return ready_samples_ > while_samples_ ||
           speed > (left_ > 0 && most_ < limits.overspeed ? most_ : limits.overspeed);
  }

 private:
  static constexpr std::int32_t kFilterSamples = 8;   ///< so that noise on the encoder does not count as motion
  static constexpr std::int32_t kMostSamples = 4000;  ///< twice the samples of kTime_s at 20 kHz

  Scalar velocity_{}, most_{};
  std::int32_t while_samples_ = 1, brake_samples_ = 0, left_ = 0, ready_samples_ = 0;
};

}  // namespace firmware
