// All faults with a threshold, each declared once: its name, the parameter of its threshold, the limits of the
// threshold, and how it is found. Enumeration, parameter table, units, checks, refusals and pages are generated from
// the list at the end.
#pragma once

#include <array>
#include <cstdint>
#include <tuple>
#include <type_traits>

#include "firmware/core/axis_telemetry.hpp"
#include "firmware/core/refusal.hpp"
#include "firmware/core/supervision/fault_info.hpp"
#include "firmware/core/supervision/monitor_ceilings.hpp"
#include "firmware/core/supervision/threshold.hpp"

namespace firmware {

/// A declaration has
///   kFaults        its rows of the table of faults; a new one is AxisFault{the next number}
///   Limits         its thresholds as the monitor is told them: mm (m), rad/s (m/s), V, samples, counts
///   kThresholds    the parameter of each of them; a refusal names the first. Initial values are the paper's x axis'
///   protects       whether the thresholds do; none may switch its monitor off but of a part that need not be fitted
///   Watch          finds the fault; left out where one that knows the drive does (axis_monitors.hpp,
///   effort_monitor.hpp,
///                  travel_monitor.hpp, index_monitor.hpp). It has restart(), and watch() for each sample of a closed
///                  loop, or watch_part() for each sample, which is shown the axis's hardware
///   kWhyRefused    words for the refusal where it needs no figures of the axis (host/parameters/set_refusal.cpp)
namespace monitored {

namespace ceilings = monitor_ceilings;

template <typename Scalar>
constexpr bool is_share(Scalar value) {
  return value >= Scalar(0) && ScalarTraits<Scalar>::is_finite(value);
}

struct FollowingError {
  static constexpr std::array kFaults = std::to_array<FaultInfo>({
      {.fault = AxisFault::following_error,
       .name = "following_error",
       .cause = "the following error exceeds its limit at this speed: the axis is blocked or overloaded, or its drive "
                "is weak",
       .remedy = "free the axis; check load and amplifier; lower acceleration; raise the limit only if the largest "
                 "error of normal moves is near it",
       .reaction = FaultReaction::sensor_stop},
  });
  template <typename Scalar>
  struct Limits {
    Scalar following_error_floor{};         ///< following error that is allowed at standstill, > 0
    Scalar following_error_per_velocity{};  ///< what each rad/s (m/s) of reference velocity adds to it, mm s/rad (s)
  };
  template <typename Scalar>
  static constexpr auto kThresholds = std::make_tuple(threshold(&Limits<Scalar>::following_error_floor,
                                                                {.id = 144,
                                                                 .name = "monitor.following_error",
                                                                 .quantity = Quantity::length,
                                                                 .minimum = 1e-9F,
                                                                 .maximum = 1e4F,
                                                                 .initial = 0.5F,
                                                                 .doc = "largest following error at standstill"}),
                                                      threshold(&Limits<Scalar>::following_error_per_velocity,
                                                                {.id = 145,
                                                                 .name = "monitor.following_error_per_speed",
                                                                 .quantity = Quantity::length_per_velocity,
                                                                 .minimum = 0,
                                                                 .maximum = 1e3F,
                                                                 .initial = 0.005F,
                                                                 .doc = "increase of it per speed of the reference"}));

  template <typename Scalar>
  static constexpr bool protects(const AxisParameters<Scalar>& p, const ceilings::Scaled<Scalar>& scaled) {
    const Limits<Scalar>& m = p.monitors;
    const Scalar travel = p.lead * p.sample_period_s;
    constexpr float kTimes = ceilings::kFollowing_s / kLoadTime_s;
    const Scalar by_full_command = scaled.full_change * travel * Scalar(0.5f * kTimes * kTimes) / scaled.share;
    const Scalar by_velocity = p.velocity_limit * p.sample_period_s * Scalar(ceilings::kFollowingTime_s / kLoadTime_s);
    const Scalar floor = m.following_error_floor * scaled.share;
    return is_positive(m.following_error_floor) && is_share(m.following_error_per_velocity) &&
           (floor <= by_full_command || floor <= by_velocity) &&
           m.following_error_per_velocity * scaled.share <= travel * Scalar(ceilings::kFollowingTime_s / kLoadTime_s);
  }
};

struct Disagreement {
  static constexpr std::array kFaults = std::to_array<FaultInfo>({
      {.fault = AxisFault::encoder_tachometer_disagreement,
       .name = "encoder_tachometer_disagreement",
       .cause = "encoder and tachometer report different speeds: one is dead, reversed, has an offset, or its wires "
                "are swapped",
       .remedy = "turn the shaft by hand and compare both readings; calibrate the tachometer; check coupling and wires",
       .reaction = FaultReaction::sensor_stop,
       .loses_position = true},
      {.fault = AxisFault::encoder_jump,
       .name = "encoder_jump",
       .cause = "the encoder left the drive's motion within one sample: wires cut or interchanged, counts lost, noise",
       .remedy = "check shield and earth, the encoder's frequency limit and its supply",
       .reaction = FaultReaction::sensor_stop,
       .loses_position = true},
  });
  template <typename Scalar>
  struct Limits {
    Scalar disagreement_floor{};  ///< difference of encoder and tachometer, allowed at standstill, > 0
    Scalar disagreement_share{};  ///< what it may grow to, as a share of the speed; 0..1
    Scalar encoder_jump{};        ///< the same difference within one sample, > disagreement_floor
  };
  template <typename Scalar>
  static constexpr auto kThresholds =
      std::make_tuple(threshold(&Limits<Scalar>::disagreement_floor,
                                {.id = 146,
                                 .name = "monitor.disagreement",
                                 .quantity = Quantity::velocity,
                                 .minimum = 1e-9F,
                                 .maximum = 1e4F,
                                 .initial = 10,
                                 .doc = "largest difference of encoder and tachometer at standstill"}),
                      threshold(&Limits<Scalar>::disagreement_share, {.id = 147,
                                                                      .name = "monitor.disagreement_share",
                                                                      .quantity = Quantity::share,
                                                                      .minimum = 0,
                                                                      .maximum = 1,
                                                                      .initial = 0.1F,
                                                                      .doc = "share of the speed added to it"}),
                      threshold(&Limits<Scalar>::encoder_jump, {.id = 148,
                                                                .name = "monitor.encoder_jump",
                                                                .quantity = Quantity::velocity,
                                                                .minimum = 1e-9F,
                                                                .maximum = 1e4F,
                                                                .initial = 62.5F,
                                                                .doc = "largest such difference in one sample"}));

  template <typename Scalar>
  static constexpr bool protects(const AxisParameters<Scalar>& p, const ceilings::Scaled<Scalar>& scaled) {
    const Limits<Scalar>& m = p.monitors;
    return is_positive(m.disagreement_floor) && is_share(m.disagreement_share) && m.disagreement_share <= Scalar(1) &&
           is_positive(m.encoder_jump) && m.encoder_jump > m.disagreement_floor &&
           scaled.is_speed_below(m.disagreement_floor, ceilings::kDisagreement_s, 1, 8) &&
           scaled.is_speed_below(m.encoder_jump, ceilings::kJump_s, 2, 32);
  }
};

struct Overspeed {
  static constexpr std::array kFaults = std::to_array<FaultInfo>({
      {.fault = AxisFault::overspeed,
       .name = "overspeed",
       .cause = "the drive is faster than its limit",
       .remedy = "look for a stuck D/A output or a wrong gain; check the limit against the velocity limit",
       .reaction = FaultReaction::drop_enable},
  });
  template <typename Scalar>
  struct Limits {
    Scalar overspeed{};  ///< > 0
  };
  template <typename Scalar>
  static constexpr auto kThresholds = std::make_tuple(threshold(&Limits<Scalar>::overspeed,
                                                                {.id = 149,
                                                                 .name = "monitor.overspeed",
                                                                 .quantity = Quantity::velocity,
                                                                 .minimum = 1e-9F,
                                                                 .maximum = 1e4F,
                                                                 .initial = 300,
                                                                 .doc = "largest speed"}));

  template <typename Scalar>
  static constexpr bool protects(const AxisParameters<Scalar>& p, const ceilings::Scaled<Scalar>& scaled) {
    const Limits<Scalar>& m = p.monitors;
    return is_positive(m.overspeed) && m.overspeed > scaled.fastest + scaled.count &&
           scaled.is_speed_below(m.overspeed, ceilings::kOverspeed_s, 3, 8);
  }
};

struct CommandEffect {
  static constexpr std::array kFaults = std::to_array<FaultInfo>({
      {.fault = AxisFault::feedback_polarity,
       .name = "feedback_polarity",
       .cause = "the drive accelerates against its command: motor or both sensors reversed, the D/A output stuck, or a "
                "load stronger than the drive",
       .remedy = "swap the motor's leads, or the sign of encoder and tachometer",
       .reaction = FaultReaction::drop_enable},
      {.fault = AxisFault::command_without_motion,
       .name = "command_without_motion",
       .cause = "the encoder shows no motion although the command should have moved the axis: a dead encoder, a "
                "blocked axis, a brake that holds, a motor with no or wrong current, or a tachometer that reads "
                "wrong",
       .remedy = "turn the shaft by hand and watch the position; free the axis; check the motor's leads and the "
                 "encoder's coupling",
       .reaction = FaultReaction::drop_enable,
       .loses_position = true},
  });
  template <typename Scalar>
  struct Limits {
    Scalar polarity_command_V{};  ///< a command beyond any friction: it must accelerate the drive; > 0
  };
  template <typename Scalar>
  static constexpr auto kThresholds = std::make_tuple(threshold(
      &Limits<Scalar>::polarity_command_V, {.id = 150,
                                            .name = "monitor.polarity_command",
                                            .quantity = Quantity::command,
                                            .minimum = 1e-3F,
                                            .maximum = 1e3F,
                                            .initial = 3,
                                            .doc = "command above any friction: it must accelerate the drive"}));

  template <typename Scalar>
  static constexpr bool protects(const AxisParameters<Scalar>& p, const ceilings::Scaled<Scalar>&) {
    const Scalar command = p.monitors.polarity_command_V;
    return is_positive(command) && command <= p.dac_limit_V * Scalar(ceilings::kCommandShare);
  }
};

struct Oscillation {
  static constexpr std::array kFaults = std::to_array<FaultInfo>({
      {.fault = AxisFault::limit_cycle,
       .name = "limit_cycle",
       .cause = "the command oscillates without commanded motion: the loop is unstable or nearly so, or its "
                "tachometer is dead",
       .remedy = "turn the shaft by hand and watch the tachometer; design the gains again with less bandwidth; check "
                 "inertia, delay and resonances; raise the limit only if the tachometer's noise is the cause",
       .reaction = FaultReaction::drop_enable},
  });
  template <typename Scalar>
  struct Limits {
    Scalar oscillation_V{};  ///< rms that the feedback may swing by, > 0
  };
  template <typename Scalar>
  static constexpr auto kThresholds =
      std::make_tuple(threshold(&Limits<Scalar>::oscillation_V,
                                {.id = 154,
                                 .name = "monitor.oscillation",
                                 .quantity = Quantity::command,
                                 .minimum = 1e-3F,
                                 .maximum = 1e3F,
                                 .initial = 2.5F,
                                 .doc = "largest rms oscillation of the feedback's command without commanded motion"}));

  template <typename Scalar>
  static constexpr bool protects(const AxisParameters<Scalar>& p, const ceilings::Scaled<Scalar>&) {
    const Scalar swing = p.monitors.oscillation_V;
    return is_positive(swing) && swing <= p.dac_limit_V * Scalar(ceilings::kOscillationShare);
  }
};

struct TravelEnds {
  static constexpr std::array kFaults = std::to_array<FaultInfo>({
      {.fault = AxisFault::travel_limit,
       .name = "travel_limit",
       .cause = "the axis would leave its travel",
       .remedy = "move back inside; check the target and the home position",
       .reaction = FaultReaction::ramp_stop},
  });
  template <typename Scalar>
  struct Limits {
    std::int64_t travel_min_counts = 0;  ///< encoder counts
    std::int64_t travel_max_counts = 0;  ///< > travel_min_counts
  };
  template <typename Scalar>
  static constexpr auto kThresholds =
      std::make_tuple(threshold(&Limits<Scalar>::travel_max_counts, {.id = 152,
                                                                     .name = "monitor.travel_max",
                                                                     .quantity = Quantity::travel,
                                                                     .minimum = -1e6F,
                                                                     .maximum = 1e6F,
                                                                     .initial = 1e5F,
                                                                     .doc = "end of travel; watched once homed"}),
                      threshold(&Limits<Scalar>::travel_min_counts, {.id = 151,
                                                                     .name = "monitor.travel_min",
                                                                     .quantity = Quantity::travel,
                                                                     .minimum = -1e6F,
                                                                     .maximum = 1e6F,
                                                                     .initial = -1e5F,
                                                                     .doc = "end of travel; watched once homed"}));
  static constexpr const char* kWhyRefused = "monitor.travel_min must be below monitor.travel_max";

  template <typename Scalar>
  static constexpr bool protects(const AxisParameters<Scalar>& p, const ceilings::Scaled<Scalar>&) {
    return p.monitors.travel_min_counts < p.monitors.travel_max_counts;
  }
};

struct IndexSpacing {
  static constexpr std::array kFaults = std::to_array<FaultInfo>({
      {.fault = AxisFault::index_mismatch,
       .name = "index_mismatch",
       .cause = "the counts between two index pulses are not whole turns, or a turn passed without a pulse: counts "
                "lost or gained, or a dead index line",
       .remedy = "check shield and earth, the encoder's frequency limit and the index wires; check "
                 "encoder.index_spacing",
       .reaction = FaultReaction::drop_enable,
       .loses_position = true},
  });
  template <typename Scalar>
  struct Limits {
    std::int32_t index_spacing = 0;  ///< counts from one index pulse to the next; 0: not watched
  };
  template <typename Scalar>
  static constexpr auto kThresholds = std::make_tuple(
      threshold(&Limits<Scalar>::index_spacing,
                {.id = 251,
                 .name = "encoder.index_spacing",
                 .quantity = Quantity::counts,
                 .minimum = 0,
                 .maximum = 1e6F,
                 .initial = 0,
                 .doc = "counts between two index pulses, which are then monitored; 0: no index is wired"}));

  template <typename Scalar>
  static constexpr bool protects(const AxisParameters<Scalar>& p, const ceilings::Scaled<Scalar>&) {
    return p.monitors.index_spacing >= 0;
  }
};

struct Saturation {
  static constexpr std::array kFaults = std::to_array<FaultInfo>({
      {.fault = AxisFault::saturation_too_long,
       .name = "saturation_too_long",
       .cause = "the D/A converter stayed at its limit: blocked axis, weak drive, or limits set too high",
       .remedy = "free the axis; lower acceleration or the gains",
       .reaction = FaultReaction::drop_enable},
  });
  template <typename Scalar>
  struct Limits {
    std::int32_t saturation_samples = 0;  ///< longest time at the D/A converter's limit, > 0
  };
  template <typename Scalar>
  static constexpr auto kThresholds = std::make_tuple(threshold(&Limits<Scalar>::saturation_samples,
                                                                {.id = 153,
                                                                 .name = "monitor.saturation_time",
                                                                 .quantity = Quantity::time,
                                                                 .minimum = 1e-3F,
                                                                 .maximum = 10,
                                                                 .initial = 0.1F,
                                                                 .doc = "longest time at the D/A converter's limit"}));
  static constexpr const char* kWhyRefused = "above 1 s it would not protect";

  template <typename Scalar>
  static constexpr bool protects(const AxisParameters<Scalar>& p, const ceilings::Scaled<Scalar>& scaled) {
    const std::int32_t samples = p.monitors.saturation_samples;
    return samples > 0 && scaled.is_time_below(samples, ceilings::kSaturation_s);
  }

  template <typename Scalar>
  class Watch {
   public:
    constexpr void restart() { samples_ = 0; }
    constexpr AxisFault watch(const AxisTelemetry<Scalar>& seen, const Limits<Scalar>& limits) {
      if (!seen.saturated) {  // nearly always
        samples_ = 0;
        return AxisFault::none;
      }
      return ++samples_ > limits.saturation_samples ? AxisFault::saturation_too_long : AxisFault::none;
    }

   private:
    std::int32_t samples_ = 0;
  };
};

struct ConverterState {
  static constexpr std::array kFaults = std::to_array<FaultInfo>({
      {.fault = AxisFault::converter_not_as_set,
       .name = "converter_not_as_set",
       .cause = "the D/A converter's read-back differs from its setting: its supply failed, an output is shorted, it "
                "is too hot, or a wire to it is broken",
       .remedy = "look at the report on the service port; check the converter's supplies, the cable to the amplifier "
                 "and its load",
       .reaction = FaultReaction::drop_enable},
  });
  template <typename Scalar>
  struct Limits {};
  template <typename Scalar>
  static constexpr std::tuple<> kThresholds{};

  template <typename Scalar>
  class Watch {
   public:
    constexpr void restart() {}
    template <typename Hal>
    constexpr AxisFault watch_part(Hal& hal, const Limits<Scalar>&) {
      return hal.dac().is_healthy() ? AxisFault::none : AxisFault::converter_not_as_set;
    }
  };
};

template <typename Declaration>
inline constexpr bool kHasThresholds =
    std::tuple_size_v<std::remove_cvref_t<decltype(Declaration::template kThresholds<float>)>> != 0;

template <typename Declaration>
constexpr Refusal refusal_of() {
  return static_cast<Refusal>(std::get<0>(Declaration::template kThresholds<float>).row.id);
}

template <typename Declaration, typename Scalar>
constexpr auto watch_of() {
  if constexpr (requires { typename Declaration::template Watch<Scalar>; })
    return std::tuple<typename Declaration::template Watch<Scalar>>{};
  else
    return std::tuple<>{};
}

}  // namespace monitored

template <typename... Declarations>
struct MonitoredFaultList {
  template <typename Scalar>
  struct Limits : Declarations::template Limits<Scalar>... {};

  template <typename Scalar>
  using Watches = decltype(std::tuple_cat(monitored::watch_of<Declarations, Scalar>()...));

  /// `visit`: a generic function that gets each declaration.
  template <typename Visit>
  static constexpr void for_each(Visit visit) {
    (visit(Declarations{}), ...);
  }
};

/// The order is that of the checks, and of the watches.
using MonitoredFaults = MonitoredFaultList<monitored::FollowingError, monitored::Disagreement, monitored::Overspeed,
                                           monitored::CommandEffect, monitored::Oscillation, monitored::TravelEnds,
                                           monitored::IndexSpacing, monitored::Saturation, monitored::ConverterState>;

}  // namespace firmware
