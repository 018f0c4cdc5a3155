// After the enable has dropped: the amplifier must say so, and the drive must not gain speed.
#pragma once

#include <cstdint>

#include "firmware/core/axis_parameters.hpp"

namespace firmware {

/// Otherwise the amplifier drives on: its enable is welded or wired past the board, and only its power can be cut. A
/// ready contact has kTime_s to open. The speed is looked at for as long, once a brake has had its time to hold: until
/// then an axis under weight falls.
template <typename Scalar>
class DropWatch {
 public:
  static constexpr float kTime_s = 0.1f;

  constexpr void configure(const AxisParameters<Scalar>& p) {
    const Scalar share = p.monitors.load_share * Scalar(kLoadTime_s / kTime_s);
    while_samples_ = 1;
    for (Scalar sum = share; sum < Scalar(1) && while_samples_ < kMostSamples; sum = sum + share) ++while_samples_;
    ready_input_ = p.sequence.ready_input;
    brake_samples_ = p.sequence.brake_fitted ? p.sequence.brake_application : 0;
    gain_ = p.monitors.disagreement_floor * Scalar(2);
    left_ = gaining_ = 0;
  }

  constexpr void begin() { left_ = brake_samples_ + while_samples_; }
  constexpr void end() { left_ = 0; }
  constexpr bool is_active() const { return left_ > 0; }

  /// Each sample while active: whether the drive is still on. `speed`: magnitude, by the slower sensor.
  constexpr bool is_on(bool says_ready, Scalar speed) {
    --left_;
    if (left_ >= while_samples_) return false;
    if (left_ == while_samples_ - 1) speed_ = speed;
    gaining_ = speed > speed_ + gain_ ? gaining_ + 1 : 0;
    if (gaining_ >= kGainingSamples) return true;
    return left_ == 0 && ready_input_ && says_ready;
  }

 private:
  static constexpr std::int32_t kGainingSamples = 5;  ///< no single bad reading
  static constexpr std::int32_t kMostSamples = 4000;  ///< of kTime_s at 20 kHz, twice

  Scalar gain_{}, speed_{};
  std::int32_t while_samples_ = 1, brake_samples_ = 0, left_ = 0, gaining_ = 0;
  bool ready_input_ = false;
};

}  // namespace firmware
