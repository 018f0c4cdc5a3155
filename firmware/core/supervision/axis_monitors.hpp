// Watches one axis, sample by sample, and says what is wrong with it.
#pragma once

#include <cstdint>

#include "firmware/core/axis_parameters.hpp"
#include "firmware/core/axis_telemetry.hpp"
#include "hal/limit_inputs.hpp"

namespace firmware {

template <typename Scalar>
class AxisMonitors {
 public:
  /// `p.monitors` has passed its check.
  constexpr void configure(const AxisParameters<Scalar>& p) {
    limits_ = p.monitors;
    velocity_per_count_ = p.encoder_resolution / (p.lead * p.sample_period_s);
    dac_limit_V_ = p.dac_limit_V;
    tachometer_fitted_ = p.tachometer_fitted;
    restart();
    forget_high_water();
  }

  /// Before the first sample of a self-test: nothing is known of the time before.
  constexpr void restart() {
    disagreement_ = Scalar(0);
    saturated_samples_ = reversed_samples_ = 0;
  }

  /// Faults of the sensors, which count whether the loop is closed or not.
  constexpr AxisFault watch_sensors(const AxisTelemetry<Scalar>& seen) {
    const Scalar measured = tachometer_fitted_ ? seen.tachometer_velocity : seen.estimate.velocity;
    const Scalar difference = Traits::times(seen.encoder_travel, velocity_per_count_) - measured;
    if (magnitude(difference) > limits_.encoder_jump)
      return which_jumped(difference + measured, measured, seen.reference_velocity);
    disagreement_ = disagreement_ + (difference - disagreement_) * kFilterShare;
    if (magnitude(disagreement_) > limits_.disagreement_floor + limits_.disagreement_share * magnitude(measured))
      return AxisFault::encoder_tachometer_disagreement;
    return AxisFault::none;
  }

  /// Faults of a closed loop. `seen` is this sample's.
  constexpr AxisFault watch_motion(const AxisTelemetry<Scalar>& seen) {
    const Scalar error = magnitude(seen.position_error);
    if (error > high_water_) high_water_ = error;
    if (error >
        limits_.following_error_floor + limits_.following_error_per_velocity * magnitude(seen.reference_velocity))
      return AxisFault::following_error;
    if (magnitude(seen.estimate.velocity) > limits_.overspeed) return AxisFault::overspeed;
    if (magnitude(seen.control_V) > limits_.polarity_command_V && is_reversed(seen))
      return AxisFault::feedback_polarity;
    if (!seen.saturated)
      saturated_samples_ = 0;
    else if (++saturated_samples_ > limits_.saturation_samples)
      return AxisFault::saturation_too_long;
    return AxisFault::none;
  }

  /// Only motion that leads out counts: an axis that stands beyond an end may always go back.
  template <hal::LimitInputs Switches>
  constexpr AxisFault watch_travel(const AxisTelemetry<Scalar>& seen, Switches& switches) const {
    if (seen.reference_velocity > Scalar(0)) {
      if (switches.read().positive_end) return AxisFault::limit_switch_positive;
      if (seen.encoder_counts > limits_.travel_max_counts) return AxisFault::travel_limit;
    } else if (seen.reference_velocity < Scalar(0)) {
      if (switches.read().negative_end) return AxisFault::limit_switch_negative;
      if (seen.encoder_counts < limits_.travel_min_counts) return AxisFault::travel_limit;
    }
    return AxisFault::none;
  }

  /// While the loop is open there is nothing to follow, and no control signal that a broken state would show in.
  constexpr AxisFault watch_rest(const AxisTelemetry<Scalar>& seen) {
    saturated_samples_ = reversed_samples_ = 0;
    const bool is_broken = Traits::is_nan(seen.estimate.offset + seen.estimate.velocity + seen.estimate.disturbance);
    return is_broken ? AxisFault::state_not_a_number : AxisFault::none;
  }

  /// Largest following error since the parameters were accepted, mm (m).
  constexpr Scalar high_water() const { return high_water_; }
  constexpr void forget_high_water() { high_water_ = Scalar(0); }

 private:
  /// Of two sensors that part within one sample, the one that left the reference is the bad one.
  static constexpr AxisFault which_jumped(Scalar encoder, Scalar tachometer, Scalar expected) {
    return magnitude(encoder - expected) >= magnitude(tachometer - expected)
               ? AxisFault::encoder_jump
               : AxisFault::encoder_tachometer_disagreement;
  }

  using Traits = ScalarTraits<Scalar>;
  static constexpr Scalar kFilterShare = Scalar(1.0f / (1 << kDisagreementShift));

  static constexpr Scalar magnitude(Scalar value) { return Traits::magnitude(value); }

  /// A drive that is connected the wrong way round runs against its command, and looks like a disturbance of twice that
  /// command. Braking runs against it too, but by a disturbance of friction's size; a blocked drive has a disturbance
  /// of once the command, and stands.
  constexpr bool is_reversed(const AxisTelemetry<Scalar>& seen) {
    const bool forward = seen.control_V > Scalar(0);
    const auto along = [forward](Scalar value) { return forward ? value : Scalar(0) - value; };
    if (along(seen.estimate.disturbance) < limits_.polarity_command_V) {  // nearly always
      reversed_samples_ = 0;
      return false;
    }
    const Scalar given = seen.saturated ? dac_limit_V_ : along(seen.control_V);
    if (along(seen.estimate.disturbance) > given * Scalar(1.75f) &&
        along(seen.estimate.velocity) < Scalar(0) - limits_.disagreement_floor * Scalar(0.25f) &&
        magnitude(disagreement_) < limits_.disagreement_floor)  // else the estimate has a bad sensor to blame
      return ++reversed_samples_ >= kPolaritySamples;
    reversed_samples_ = 0;
    return false;
  }

  MonitorLimits<Scalar> limits_{};
  Scalar velocity_per_count_{};
  Scalar dac_limit_V_{};
  Scalar disagreement_{};
  Scalar high_water_{};
  std::int32_t saturated_samples_ = 0;
  std::int32_t reversed_samples_ = 0;
  bool tachometer_fitted_ = true;
};

}  // namespace firmware
