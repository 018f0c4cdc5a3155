// Monitors the ends of travel: switches and limits, by the encoder's motion.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "firmware/core/arithmetic/count_position.hpp"
#include "firmware/core/axis_parameters.hpp"
#include "firmware/core/axis_telemetry.hpp"
#include "hal/limit_inputs.hpp"

namespace firmware {

/// A homed axis keeps to its limits. One that is not homed may leave the place where it was enabled by no more than the
/// distance between the limits; while it homes, the sequence limits its travel. The switches always apply. Beyond an
/// end an axis may stand still and move back, but not move farther out, by command or by itself: the limit is the
/// innermost position since it passed the end, plus a little play for a loop that holds its position.
template <typename Scalar>
class TravelMonitor {
 public:
  /// Counts: `stop`, the longest stopping distance of a jog; `beyond`, the largest offset that compensation adds to a
  /// reference.
  constexpr void configure(const AxisParameters<Scalar>& p, std::int64_t stop, std::int64_t beyond = 0) {
    beyond_ = beyond;
    limits_ = {p.monitors.travel_min_counts, p.monitors.travel_max_counts};
    play_ = play_in_counts(p);
    positive_end_.configure(p.monitors.input_samples);
    negative_end_.configure(p.monitors.input_samples);
    margin_ = stop + play_ + error_in_counts(p);
    bound_by_limits();
  }

  /// A quarter of the following error allowed at standstill, and two counts.
  static constexpr std::int64_t play_in_counts(const AxisParameters<Scalar>& p) {
    const Scalar counts = p.monitors.following_error_floor / p.encoder_resolution;
    constexpr Scalar kMost = Scalar(1000.0f);
    return 2 + ScalarTraits<Scalar>::truncate(counts < kMost ? counts * Scalar(0.25f) : kMost * Scalar(0.25f));
  }

  /// The largest following error that is not a fault.
  static constexpr std::int64_t error_in_counts(const AxisParameters<Scalar>& p) {
    using Traits = ScalarTraits<Scalar>;
    // Above this limit, travel is checked in every sample. The range of fixed point, whose unit is a count, is 1024.
    constexpr Scalar kMost = Scalar(std::is_floating_point_v<Scalar> ? 1e6f : 1000.0f);
    const MonitorLimits<Scalar>& m = p.monitors;
    const Scalar floor = m.following_error_floor / p.encoder_resolution;
    const Scalar per_velocity = m.following_error_per_velocity / p.encoder_resolution;
    const Scalar fastest = p.velocity_limit / p.lead;
    constexpr std::int64_t kBeyondAll = std::int64_t{1} << 40;
    if (!(floor < kMost) || !(per_velocity < kMost) || !(fastest < kMost)) return kBeyondAll;
    const auto up = [](Scalar value) { return std::int64_t{Traits::truncate(value)} + 1; };
    return up(floor) + up(per_velocity) * up(fastest) * 2;
  }

  /// A target, or a position to continue from in this direction.
  constexpr bool is_inside(std::int64_t counts) const { return counts >= min_counts_ && counts <= max_counts_; }
  constexpr bool has_room(std::int64_t counts, bool forward) const {
    return forward ? counts + play_ < max_counts_ : counts - play_ > min_counts_;
  }
  /// From `here` by this many counts.
  constexpr bool has_way(std::int64_t here, std::int64_t counts) const {
    return counts <= max_counts_ - here && counts >= min_counts_ - here;
  }
  constexpr std::int64_t play() const { return play_; }
  constexpr std::int64_t min_counts() const { return min_counts_; }
  constexpr std::int64_t max_counts() const { return max_counts_; }

  /// For an axis that is homed from now on.
  constexpr void bound_by_limits() { keep_between(limits_[0], limits_[1]); }
  /// For an axis that is not homed and stands here.
  constexpr void bound_from(std::int64_t here) {
    const std::int64_t whole = limits_[1] - limits_[0];
    keep_between(here - whole, here + whole);
  }
  /// For a homing sequence.
  constexpr void unbound() { keep_between(-kAnywhere, kAnywhere); }

  constexpr void restart() {
    upper_bound_ = std::numeric_limits<std::int64_t>::max();
    lower_bound_ = std::numeric_limits<std::int64_t>::min();
    is_near_end_ = true;  // not known yet
  }

  constexpr AxisFault watch(const AxisTelemetry<Scalar>& seen, const hal::LimitState& switches) {
    const bool is_at_switch = switches.positive_end || switches.negative_end;
    if (!is_at_switch && !is_near_end_ && is_far_inside(seen)) return AxisFault::none;  // nearly always
    return watch_ends(seen, switches);
  }

  /// Whether the axis could reach an end before it has stopped, or whether this is unknown.
  constexpr bool is_near_end() const { return is_near_end_; }

 private:
  static constexpr std::int64_t kAnywhere = std::int64_t{1} << 60;

  constexpr void keep_between(std::int64_t least, std::int64_t most) {
    min_counts_ = least;
    max_counts_ = most;
    far_inside_ = CountRange(least + margin_, most - margin_);
    restart();
  }

  [[gnu::noinline]] constexpr AxisFault watch_ends(const AxisTelemetry<Scalar>& seen, const hal::LimitState& switches) {
    const std::int64_t counts = seen.encoder_counts;
    const bool at_positive_end = positive_end_.filtered(switches.positive_end);
    const bool at_negative_end = negative_end_.filtered(switches.negative_end);
    const bool is_above = at_positive_end || counts > max_counts_ + beyond_;
    const bool is_below = at_negative_end || counts < min_counts_ - beyond_;
    is_near_end_ =
        is_above || is_below || !is_far_inside(seen) || positive_end_.is_pending() || negative_end_.is_pending();
    if (is_above) {
      if (counts + play_ < upper_bound_) upper_bound_ = counts + play_;
      if (seen.reference_velocity > Scalar(0) || counts > upper_bound_)
        return at_positive_end ? AxisFault::limit_switch_positive : AxisFault::travel_limit;
    } else {
      upper_bound_ = std::numeric_limits<std::int64_t>::max();
    }
    if (is_below) {
      if (counts - play_ > lower_bound_) lower_bound_ = counts - play_;
      if (seen.reference_velocity < Scalar(0) || counts < lower_bound_)
        return at_negative_end ? AxisFault::limit_switch_negative : AxisFault::travel_limit;
    } else {
      lower_bound_ = std::numeric_limits<std::int64_t>::min();
    }
    return AxisFault::none;
  }

  constexpr bool is_far_inside(const AxisTelemetry<Scalar>& seen) const {
    return far_inside_.contains(seen.encoder_counts);
  }

  CountRange far_inside_;  ///< with room for any stop and any following error
  bool is_near_end_ = true;
  InputFilter positive_end_, negative_end_;
  std::array<std::int64_t, 2> limits_{};  ///< of the homed axis
  std::int64_t margin_ = 0;
  std::int64_t min_counts_ = 0, max_counts_ = 0, play_ = 0, beyond_ = 0;
  std::int64_t upper_bound_ = 0, lower_bound_ = 0;
};

}  // namespace firmware
