// The ends of travel: switches and limits, by the motion that the encoder shows.
#pragma once

#include <cstdint>
#include <limits>

#include "firmware/core/axis_parameters.hpp"
#include "firmware/core/axis_telemetry.hpp"
#include "firmware/core/count_position.hpp"
#include "hal/limit_inputs.hpp"

namespace firmware {

/// The limits count once the axis is homed, the switches always. Beyond an end an axis may stand, and may go back. It
/// may neither be led farther out nor go there by itself: the innermost place that it has reached since it came beyond
/// the end, and a little play for a loop that holds its place, is as far out as it may be.
template <typename Scalar>
class TravelMonitor {
 public:
  constexpr void configure(const AxisParameters<Scalar>& p) {
    min_counts_ = p.monitors.travel_min_counts;
    max_counts_ = p.monitors.travel_max_counts;
    inside_ = CountRange(min_counts_, max_counts_);
    play_ = play_in_counts(p);
    restart();
  }

  /// A quarter of the following error that is allowed at standstill, and two counts.
  static constexpr std::int64_t play_in_counts(const AxisParameters<Scalar>& p) {
    const Scalar counts = p.monitors.following_error_floor / p.encoder_resolution;
    constexpr Scalar kMost = Scalar(1000.0f);
    return 2 + ScalarTraits<Scalar>::truncate(counts < kMost ? counts * Scalar(0.25f) : kMost * Scalar(0.25f));
  }

  /// A target, or a place to go on from in this direction.
  constexpr bool is_inside(std::int64_t counts) const { return counts >= min_counts_ && counts <= max_counts_; }
  constexpr bool has_room(std::int64_t counts, bool forward) const {
    return forward ? counts + play_ < max_counts_ : counts - play_ > min_counts_;
  }
  /// From `here` by so many counts.
  constexpr bool has_way(std::int64_t here, std::int64_t counts) const {
    return counts <= max_counts_ - here && counts >= min_counts_ - here;
  }
  constexpr std::int64_t play() const { return play_; }
  constexpr std::int64_t min_counts() const { return min_counts_; }
  constexpr std::int64_t max_counts() const { return max_counts_; }

  constexpr void restart() {
    upper_bound_ = std::numeric_limits<std::int64_t>::max();
    lower_bound_ = std::numeric_limits<std::int64_t>::min();
    is_beyond_ = false;
  }

  constexpr AxisFault watch(const AxisTelemetry<Scalar>& seen, const hal::LimitState& switches) {
    const bool is_at_switch = switches.positive_end || switches.negative_end;
    if (!is_at_switch && !is_beyond_ && (!seen.homed || inside_.contains(seen.encoder_counts))) return AxisFault::none;
    return watch_ends(seen, switches);
  }

 private:
  [[gnu::noinline]] constexpr AxisFault watch_ends(const AxisTelemetry<Scalar>& seen, const hal::LimitState& switches) {
    const std::int64_t counts = seen.encoder_counts;
    const bool is_above = switches.positive_end || (seen.homed && counts > max_counts_);
    const bool is_below = switches.negative_end || (seen.homed && counts < min_counts_);
    is_beyond_ = is_above || is_below;
    if (is_above) {
      if (counts + play_ < upper_bound_) upper_bound_ = counts + play_;
      if (seen.reference_velocity > Scalar(0) || counts > upper_bound_)
        return switches.positive_end ? AxisFault::limit_switch_positive : AxisFault::travel_limit;
    } else {
      upper_bound_ = std::numeric_limits<std::int64_t>::max();
    }
    if (is_below) {
      if (counts - play_ > lower_bound_) lower_bound_ = counts - play_;
      if (seen.reference_velocity < Scalar(0) || counts < lower_bound_)
        return switches.negative_end ? AxisFault::limit_switch_negative : AxisFault::travel_limit;
    } else {
      lower_bound_ = std::numeric_limits<std::int64_t>::min();
    }
    return AxisFault::none;
  }

  CountRange inside_;
  bool is_beyond_ = false;  ///< one of the bounds is set
  std::int64_t min_counts_ = 0, max_counts_ = 0, play_ = 0;
  std::int64_t upper_bound_ = 0, lower_bound_ = 0;
};

}  // namespace firmware
