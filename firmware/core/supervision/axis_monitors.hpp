// Monitors one axis in each sample and reports its faults.
#pragma once

#include <cstdint>

#include "firmware/core/axis_parameters.hpp"
#include "firmware/core/axis_telemetry.hpp"
#include "firmware/core/supervision/effort_monitor.hpp"
#include "firmware/core/supervision/travel_monitor.hpp"

namespace firmware {

/// The monitors use sensor readings, never the estimate, which is wrong if the estimator's gains are.
template <typename Scalar>
class AxisMonitors {
 public:
  /// `p.monitors` has passed its check. `longest_stop`: counts, of a jog.
  constexpr void configure(const AxisParameters<Scalar>& p, std::int64_t longest_stop, std::int64_t beyond = 0) {
    limits_ = p.monitors;
    velocity_per_count_ = p.encoder_resolution / (p.lead * p.sample_period_s);
    tachometer_fitted_ = p.tachometer_fitted;
    effort_.configure(p);
    travel_.configure(p, longest_stop, beyond);
    restart();
    forget_high_water();
  }

  /// Call it before the first sample of a self-test, when the past is unknown.
  constexpr void restart() {
    disagreement_ = Scalar(0);
    encoder_velocity_ = Scalar(0);
    restart_motion();
    travel_.restart();
  }

  /// Faults that the axis's hardware reports.
  template <typename Hal>
  constexpr AxisFault watch_parts(Hal& hal) {
    return hal.dac().is_healthy() ? AxisFault::none : AxisFault::converter_not_as_set;
  }

  /// Faults of the sensors, in open and in closed loop.
  constexpr AxisFault watch_sensors(const AxisTelemetry<Scalar>& seen) {
    const Scalar measured = tachometer_fitted_ ? seen.tachometer_velocity : seen.estimate.velocity;
    const Scalar before = encoder_velocity_;
    encoder_velocity_ = Traits::times(seen.encoder_travel, velocity_per_count_);
    const Scalar difference = encoder_velocity_ - measured;
    if (magnitude(encoder_velocity_ - before) > limits_.encoder_jump) return AxisFault::encoder_jump;
    if (magnitude(difference) > limits_.encoder_jump)
      return which_jumped(encoder_velocity_, measured, seen.reference_velocity);
    disagreement_ = disagreement_ + (difference - disagreement_) * kFilterShare;
    const Scalar parted = magnitude(disagreement_);
    if (parted > limits_.disagreement_floor &&
        parted > limits_.disagreement_floor + limits_.disagreement_share * magnitude(measured))
      return AxisFault::encoder_tachometer_disagreement;
    return AxisFault::none;
  }

  /// Faults of a closed loop. `seen`: of this sample, already passed to watch_sensors().
  constexpr AxisFault watch_motion(const AxisTelemetry<Scalar>& seen) {
    const Scalar error = magnitude(seen.tracking_error);
    if (error > noted_error_ && !may_follow(error, seen.reference_velocity)) return AxisFault::following_error;
    if (magnitude(encoder_velocity_) > limits_.overspeed ||
        (tachometer_fitted_ && magnitude(seen.tachometer_velocity) > limits_.overspeed))
      return AxisFault::overspeed;
    const AxisFault effort = effort_.watch(seen, encoder_velocity_);
    if (effort != AxisFault::none) return effort;
    if (!seen.saturated) {  // nearly always
      saturated_samples_ = 0;
      return AxisFault::none;
    }
    return ++saturated_samples_ > limits_.saturation_samples ? AxisFault::saturation_too_long : AxisFault::none;
  }

  template <hal::LimitInputs Switches>
  constexpr AxisFault watch_travel(const AxisTelemetry<Scalar>& seen, Switches& switches) {
    return travel_.watch(seen, switches.read());
  }

  // As for TravelMonitor.
  constexpr void bound_travel_by_limits() { travel_.bound_by_limits(); }
  constexpr void bound_travel_from(std::int64_t here) { travel_.bound_from(here); }
  constexpr void unbound_travel() { travel_.unbound(); }

  /// The smaller of the two sensors' speeds: a speed that both sensors show is not a sensor fault.
  constexpr Scalar slowest(const AxisTelemetry<Scalar>& seen) const {
    const Scalar encoder = Traits::times(seen.encoder_travel, velocity_per_count_);
    const bool is_slower = tachometer_fitted_ && magnitude(seen.tachometer_velocity) < magnitude(encoder);
    return is_slower ? seen.tachometer_velocity : encoder;
  }

  /// With the loop open there is no reference to follow and no control signal to check.
  constexpr AxisFault watch_rest(const AxisTelemetry<Scalar>& seen) {
    restart_motion();
    seen.homed ? travel_.restart() : travel_.bound_from(seen.encoder_counts);
    const bool is_broken = Traits::is_nan(seen.estimate.offset + seen.estimate.velocity + seen.estimate.disturbance);
    return is_broken ? AxisFault::state_not_a_number : AxisFault::none;
  }

  /// Largest following error since the parameters were accepted, mm (m).
  constexpr Scalar high_water() const { return high_water_; }
  constexpr void forget_high_water() { high_water_ = noted_error_ = Scalar(0); }

  constexpr const MonitorLimits<Scalar>& limits() const { return limits_; }
  constexpr const TravelMonitor<Scalar>& travel() const { return travel_; }
  constexpr const EffortMonitor<Scalar>& effort() const { return effort_; }

 private:
  using Traits = ScalarTraits<Scalar>;
  static constexpr Scalar kFilterShare = Scalar(1.0f / (1 << kDisagreementShift));

  static constexpr Scalar magnitude(Scalar value) { return Traits::magnitude(value); }

  /// If two sensors diverge within one sample, the one that left the reference is faulty.
  static constexpr AxisFault which_jumped(Scalar encoder, Scalar tachometer, Scalar expected) {
    return magnitude(encoder - expected) >= magnitude(tachometer - expected)
               ? AxisFault::encoder_jump
               : AxisFault::encoder_tachometer_disagreement;
  }

  constexpr bool may_follow(Scalar error, Scalar reference_velocity) {
    if (error > high_water_) high_water_ = error;
    const Scalar floor = limits_.following_error_floor;
    noted_error_ = high_water_ < floor ? high_water_ : floor;
    return error <= floor || error <= floor + limits_.following_error_per_velocity * magnitude(reference_velocity);
  }

  constexpr void restart_motion() {
    saturated_samples_ = 0;
    effort_.restart(encoder_velocity_);
  }

  MonitorLimits<Scalar> limits_{};
  Scalar velocity_per_count_{};
  Scalar encoder_velocity_{};
  Scalar disagreement_{};
  Scalar high_water_{};
  Scalar noted_error_{};  ///< an error up to this is neither a fault nor a new maximum; saves 5 instructions a step
  std::int32_t saturated_samples_ = 0;
  bool tachometer_fitted_ = true;
  EffortMonitor<Scalar> effort_;
  TravelMonitor<Scalar> travel_;
};

}  // namespace firmware
