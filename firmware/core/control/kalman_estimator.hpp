// Kalman estimate of position, velocity and disturbance with a constant gain, in current-observer form (eq. 43).
#pragma once

#include <array>
#include <cstdint>

#include "firmware/core/arithmetic/scalar.hpp"
#include "firmware/core/control/discrete_drive.hpp"

namespace firmware {

/// Kobs of eq. (49): rows position, velocity, disturbance; columns encoder, tachometer. The gain of the measurement
/// update, not A times it. Units follow from DiscreteDrive's, e.g. row 3: V/mm, V per rad/s. A drive without tachometer
/// has zeros in the second column.
template <typename Scalar>
using KalmanGain = std::array<std::array<Scalar, 2>, 3>;

/// x_hat = anchor_counts * dx + offset. Moving the anchor with the encoder keeps the offset within a few counts of
/// zero, so it has the same resolution at 10 m as at 0.
template <typename Scalar>
struct AxisEstimate {
  std::int64_t anchor_counts = 0;  ///< the encoder's last reading
  Scalar offset{};                 ///< estimated position minus the anchor, mm (m)
  Scalar velocity{};               ///< rad/s (m/s)
  Scalar disturbance{};            ///< V at the D/A converter: equivalent input disturbance
};

template <typename Scalar>
class KalmanEstimator {
 public:
  /// `count_length`: one encoder count, mm (m).
  constexpr void configure(const DiscreteDrive<Scalar>& drive, const KalmanGain<Scalar>& gain, Scalar count_length) {
    drive_ = drive;
    gain_ = gain;
    count_length_ = count_length;
  }

  /// At rest at the given reading, without disturbance.
  static constexpr AxisEstimate<Scalar> at_rest(std::int64_t encoder_counts) {
    return {.anchor_counts = encoder_counts};
  }

  /// Eq. (43), written as prediction and innovation, which is the same sum. `input`: u(k-1), V, the drive's input since
  /// the last call. `velocity`: tachometer, rad/s (m/s).
  constexpr void update(AxisEstimate<Scalar>& estimate, Scalar input, std::int64_t encoder_counts,
                        Scalar velocity) const {
    const Prediction predicted = predict(estimate, input, encoder_counts);
    correct(estimate, predicted, encoder_counts, velocity - predicted.velocity);
  }

  /// The same for a drive without tachometer.
  constexpr void update(AxisEstimate<Scalar>& estimate, Scalar input, std::int64_t encoder_counts) const {
    correct(estimate, predict(estimate, input, encoder_counts), encoder_counts, Scalar(0));
  }

 private:
  struct Prediction {
    Scalar offset;  ///< from the new anchor: minus the encoder's innovation
    Scalar velocity;
  };

  constexpr Prediction predict(const AxisEstimate<Scalar>& estimate, Scalar input, std::int64_t encoder_counts) const {
    const Scalar net_input = input - estimate.disturbance;
    const auto travel = static_cast<std::int32_t>(encoder_counts - estimate.anchor_counts);
    const Scalar measured = ScalarTraits<Scalar>::times(travel, count_length_);
    return {.offset = estimate.offset + drive_.Ad12 * estimate.velocity + drive_.Bd1 * net_input - measured,
            .velocity = drive_.Ad22 * estimate.velocity + drive_.Bd2 * net_input};
  }

  constexpr void correct(AxisEstimate<Scalar>& estimate, const Prediction& predicted, std::int64_t encoder_counts,
                         Scalar velocity_innovation) const {
    const Scalar position_innovation = Scalar(0) - predicted.offset;
    estimate.anchor_counts = encoder_counts;
    estimate.offset = predicted.offset + gain_[0][0] * position_innovation + gain_[0][1] * velocity_innovation;
    estimate.velocity = predicted.velocity + gain_[1][0] * position_innovation + gain_[1][1] * velocity_innovation;
    estimate.disturbance = estimate.disturbance + gain_[2][0] * position_innovation + gain_[2][1] * velocity_innovation;
  }

  DiscreteDrive<Scalar> drive_{};
  KalmanGain<Scalar> gain_{};
  Scalar count_length_{};
};

}  // namespace firmware
