// A controlled stop with one sensor, after the other has failed or the loop has lost the drive.
#pragma once

#include <cstdint>

#include "firmware/core/axis_parameters.hpp"
#include "firmware/core/axis_telemetry.hpp"
#include "firmware/core/supervision/standstill.hpp"

namespace firmware {

enum class TrustedSensor : std::uint8_t { none, encoder, tachometer };

/// Reduces the speed that the sensor shows to 0 with the fault deceleration, and holds it there:
///
///   e(k) = e(k-1) + (w_ref - w) lead Ts,   u = Kc1 e + Kc2 (w_ref - w) + load + (w_ref(k) - w_ref(k-1)) / Bd2
///
/// which is the loop's own feedback (50) with the position counted from the beginning of the stop by that sensor alone,
/// without estimator and other sensor. `load` is the mean command, mainly due to a weight. If the drive slows down by
/// itself, the reference follows. The enable drops if the drive is not under control: it is faster than the reference
/// by twice the allowed difference of the sensors, or moves in the other direction by as much, or needs the converter's
/// whole range for kMostSaturated. It also drops if the sensor shows standstill while half of that range is added to
/// the load. If the sensors diverged near rest, where the faulty one is unknown, it drops if the tachometer's speed
/// then grows by as much.
template <typename Scalar>
class SensorStop {
 public:
  constexpr void configure(const AxisParameters<Scalar>& p) {
    Kc_ = p.Kc;
    travel_per_velocity_ = p.lead * p.sample_period_s;
    velocity_per_count_ = p.encoder_resolution / travel_per_velocity_;
    const bool is_hard = p.fault_deceleration > p.acceleration_limit;
    slower_ = (is_hard ? p.fault_deceleration : p.acceleration_limit) * p.sample_period_s / p.lead;
    ramp_V_ = slower_ / p.drive.Bd2;
    astray_ = p.monitors.disagreement_floor * Scalar(2);
    limit_V_ = p.dac_limit_V;
    tachometer_fitted_ = p.tachometer_fitted;
    end();
  }

  /// The sensor to use after a fault. If two sensors diverge, it is the encoder, unless the encoder shows less than an
  /// eighth of the reference's speed. If the tachometer is faulty, the loop follows it, so that the drive leaves the
  /// reference and the tachometer does not.
  constexpr TrustedSensor trusted_after(AxisFault fault, const AxisTelemetry<Scalar>& seen) const {
    if (fault == AxisFault::tachometer_invalid || (!tachometer_fitted_ && fault == AxisFault::following_error))
      return TrustedSensor::encoder;
    if (!tachometer_fitted_) return TrustedSensor::none;
    if (fault != AxisFault::encoder_tachometer_disagreement) return TrustedSensor::tachometer;
    if (is_slow(seen)) return TrustedSensor::encoder;
    const bool forward = seen.reference_velocity > Scalar(0);
    const auto along = [forward](Scalar velocity) { return forward ? velocity : Scalar(0) - velocity; };
    const Scalar least = along(seen.reference_velocity) * Scalar(0.125f);
    return along(encoder_velocity(seen)) >= least ? TrustedSensor::encoder : TrustedSensor::tachometer;
  }

  /// `load_V`: mean command.
  constexpr void begin(TrustedSensor trusted, AxisFault fault, const AxisTelemetry<Scalar>& seen, Scalar load_V) {
    trusted_ = trusted;
    is_doubtful_ = fault == AxisFault::encoder_tachometer_disagreement && uses_encoder() && is_slow(seen);
    doubtful_most_ = Traits::magnitude(seen.tachometer_velocity) + astray_;
    velocity_ = reference_ = measured(seen);
    error_ = Scalar(0);
    load_V_ = load_V;
    samples_at_rest_ = saturated_samples_ = 0;
    still_V_ = Scalar(0);
    next(seen);
  }
  constexpr void end() { trusted_ = TrustedSensor::none; }
  constexpr bool is_active() const { return trusted_ != TrustedSensor::none; }
  constexpr bool uses_encoder() const { return trusted_ == TrustedSensor::encoder; }

  /// After each step(), with its output command_V(). False once the drive does not follow.
  constexpr bool next(const AxisTelemetry<Scalar>& seen) {
    const Scalar change = measured(seen) - velocity_;
    velocity_ = velocity_ + change * Scalar(0.5f);  // averaged, because one count in a sample is coarse
    slow_down();
    const Scalar lacking = reference_ - velocity_;
    const Scalar error = error_ + lacking * travel_per_velocity_;
    const Scalar wanted_V = Kc_[0] * error + Kc_[1] * lacking + load_V_ + ahead_V_;
    const bool is_saturated = !(Traits::magnitude(wanted_V) < limit_V_);
    if (!is_saturated) error_ = error;
    if (!is_saturated) saturated_samples_ = 0;
    if (is_saturated) ++saturated_samples_;
    command_V_ = wanted_V;
    const bool stands = Traits::magnitude(measured(seen)) < Traits::magnitude(reference_) * Scalar(0.125f);
    still_V_ = stands ? still_V_ + Traits::magnitude(wanted_V - load_V_) * Scalar(1.0f / kMostSaturated) : Scalar(0);
    if (reference_ == Scalar(0) && samples_at_rest_ < Standstill::kSamples) ++samples_at_rest_;
    const bool forward = reference_ > Scalar(0);
    const Scalar beyond = Scalar(0) - (forward ? lacking : Scalar(0) - lacking);
    const Scalar astray = reference_ == Scalar(0) ? Traits::magnitude(velocity_) : beyond;
    if (is_doubtful_ && Traits::magnitude(seen.tachometer_velocity) > doubtful_most_) return false;
    return still_V_ <= limit_V_ * Scalar(0.5f) && saturated_samples_ <= kMostSaturated && astray <= astray_ &&
           Traits::magnitude(change) <= astray_ && Traits::is_finite(wanted_V);
  }
  constexpr Scalar command_V() const { return command_V_; }
  constexpr Scalar velocity() const { return velocity_; }
  /// The reference has been at rest for a while, and the drive's speed differs from it by less than a count per sample.
  constexpr bool has_stopped() const { return samples_at_rest_ >= Standstill::kSamples; }

 private:
  using Traits = ScalarTraits<Scalar>;
  static constexpr std::int32_t kMostSaturated = 5;  ///< samples

  constexpr bool is_slow(const AxisTelemetry<Scalar>& seen) const {
    return Traits::magnitude(seen.reference_velocity) <= astray_;
  }
  constexpr Scalar encoder_velocity(const AxisTelemetry<Scalar>& seen) const {
    return Traits::times(seen.encoder_travel, velocity_per_count_);
  }
  constexpr Scalar measured(const AxisTelemetry<Scalar>& seen) const {
    return trusted_ == TrustedSensor::encoder ? encoder_velocity(seen) : seen.tachometer_velocity;
  }

  constexpr void slow_down() {
    const bool forward = reference_ > Scalar(0), stood = reference_ == Scalar(0);
    const Scalar along = forward ? velocity_ : Scalar(0) - velocity_;
    Scalar speed = Traits::magnitude(reference_) - slower_;
    const Scalar most = along + astray_ * Scalar(0.5f);
    ahead_V_ = stood || most < speed ? Scalar(0) : (forward ? Scalar(0) - ramp_V_ : ramp_V_);
    if (most < speed) speed = along;
    if (speed < slower_) speed = Scalar(0);
    reference_ = forward ? speed : Scalar(0) - speed;
  }

  StateFeedbackGain<Scalar> Kc_{};
  Scalar travel_per_velocity_{}, velocity_per_count_{}, slower_{}, ramp_V_{}, astray_{}, limit_V_{};
  Scalar velocity_{}, reference_{}, error_{}, load_V_{}, ahead_V_{}, command_V_{}, still_V_{}, doubtful_most_{};
  std::int16_t samples_at_rest_ = 0, saturated_samples_ = 0;
  TrustedSensor trusted_ = TrustedSensor::none;
  bool tachometer_fitted_ = true, is_doubtful_ = false;
};

}  // namespace firmware
