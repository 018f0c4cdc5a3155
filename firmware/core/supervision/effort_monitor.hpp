// Compares the speed that the command should cause with the encoder's, and detects an oscillating command.
#pragma once

#include "firmware/core/axis_parameters.hpp"
#include "firmware/core/axis_telemetry.hpp"

namespace firmware {

/// Needs neither the estimator nor the friction curve, so that it also works if either is wrong.
///
/// Missing speed. A command beyond any friction must change the speed. The part beyond friction gives a change by the
/// sampled drive (7); half of it is required, because the inertia may be twice the model's. The part of that half that
/// the encoder's speed lacks is summed; the sum is reset once the command is small again. It grows with a dead encoder,
/// a blocked axis, a motor without current, and a drive that runs against its command. The mean command over half a
/// second holds a load and is not counted.
///
/// Oscillation. Without its slow part, the feedback's part of the command is noise and a few transients on a healthy
/// axis. An unstable loop raises its mean square over a tenth of a second. The largest oscillation is found after at
/// least a quarter of that time, missing speed after at least five samples, so a single bad reading has no effect.
template <typename Scalar>
class EffortMonitor {
 public:
  constexpr void configure(const AxisParameters<Scalar>& p) {
    const MonitorLimits<Scalar>& m = p.monitors;
    friction_V_ = m.polarity_command_V;
    const Scalar count = p.encoder_resolution / (p.lead * p.sample_period_s);
    debt_limit_ = m.disagreement_floor * Scalar(0.5f);
    if (debt_limit_ < count * Scalar(3)) debt_limit_ = count * Scalar(3);
    largest_step_ = debt_limit_ * Scalar(0.24f);
    oscillation_square_ = m.oscillation_V * m.oscillation_V;
    quiet_square_ = oscillation_square_ * Scalar(1.0f / 64);  // saves 6 instructions a step
    promised_per_volt_ = p.drive.Bd2 * Scalar(0.5f);
    load_share_ = m.load_share;
    power_share_ = m.load_share * Scalar(kLoadTime_s / kSwingTime_s);
    mean_share_ = m.swing_share;
    restart(Scalar(0));
  }

  /// `velocity`: by the encoder, rad/s (m/s).
  constexpr void restart(Scalar velocity) {
    last_velocity_ = velocity;
    applied_V_ = load_V_ = debt_ = mean_V_ = power_ = Scalar(0);
  }

  constexpr AxisFault watch(const AxisTelemetry<Scalar>& seen, Scalar velocity) {
    const AxisFault motion = compare(velocity);
    last_velocity_ = velocity;
    applied_V_ = seen.output_V;
    load_V_ = load_V_ + (applied_V_ - load_V_) * load_share_;
    return motion != AxisFault::none ? motion : watch_swing(seen.feedback_V);
  }

  /// Mean command, which holds a load.
  constexpr Scalar load_V() const { return load_V_; }
  /// Mean square of the oscillating part of the feedback, V^2.
  constexpr Scalar swing() const { return power_; }

 private:
  using Traits = ScalarTraits<Scalar>;

  /// Compares the effect of the last sample's command with this sample's speed.
  constexpr AxisFault compare(Scalar velocity) {
    if (Traits::magnitude(applied_V_) <= friction_V_) {  // nearly always
      debt_ = Scalar(0);
      return AxisFault::none;
    }
    const bool forward = applied_V_ > Scalar(0);
    if (forward != was_forward_) debt_ = Scalar(0);
    was_forward_ = forward;
    const auto along = [forward](Scalar value) { return forward ? value : Scalar(0) - value; };
    const Scalar held = along(load_V_) > Scalar(0) ? along(load_V_) : Scalar(0);
    const Scalar beyond = along(applied_V_) - friction_V_ - held;
    const Scalar change = along(velocity - last_velocity_);
    const Scalar lacking = beyond * promised_per_volt_ - change;
    debt_ = debt_ + (lacking < largest_step_ ? lacking : largest_step_);
    if (beyond <= Scalar(0) || debt_ < Scalar(0)) debt_ = Scalar(0);
    if (debt_ <= debt_limit_) return AxisFault::none;
    return along(velocity) < Scalar(0) - debt_limit_ * Scalar(0.25f) ? AxisFault::feedback_polarity
                                                                     : AxisFault::command_without_motion;
  }

  constexpr AxisFault watch_swing(Scalar feedback_V) {
    const Scalar swing = feedback_V - mean_V_;
    mean_V_ = mean_V_ + swing * mean_share_;
    const Scalar square = swing * swing;
    if (square <= quiet_square_ && power_ == Scalar(0)) return AxisFault::none;  // nearly always
    const Scalar most = oscillation_square_ * Scalar(4);
    power_ = power_ + ((square < most ? square : most) - power_) * power_share_;
    if (power_ <= quiet_square_ && square <= quiet_square_) power_ = Scalar(0);
    return power_ > oscillation_square_ ? AxisFault::limit_cycle : AxisFault::none;
  }

  Scalar friction_V_{}, debt_limit_{}, largest_step_{}, oscillation_square_{}, quiet_square_{}, promised_per_volt_{};
  Scalar load_share_{}, power_share_{}, mean_share_{};
  Scalar applied_V_{}, load_V_{}, last_velocity_{};
  Scalar debt_{};  ///< speed that the command should have caused but the encoder does not show, rad/s (m/s)
  Scalar mean_V_{}, power_{};
  bool was_forward_ = true;
};

}  // namespace firmware
