// Time scale of a path: samples of the path per sample of the board, changed within the axes' limits.
#pragma once

#include <algorithm>

#include "firmware/core/arithmetic/count_position.hpp"
#include "firmware/core/path/path_headroom.hpp"
#include "firmware/core/path/path_piece.hpp"

namespace firmware {

namespace path_clock {

/// 1 / f^2 of a headroom f, 2^-32.
inline constexpr std::array<std::uint32_t, kHeadrooms.size()> kInverseSquares = [] {
  std::array<std::uint32_t, kHeadrooms.size()> all{};
  for (std::size_t i = 0; i != all.size(); ++i)
    all[i] = static_cast<std::uint32_t>(4294967296.0 / (kHeadrooms[i] * kHeadrooms[i]));
  return all;
}();

}  // namespace path_clock

/// Slows a path down by its clock, so that the axes never leave it. Rates are increments of one sample per sample, 0 to
/// kOneCount.
///
/// At rate r an axis on the path q has the acceleration r^2 q'' + r' q' and the jerk r^3 q''' + 3 r r' q'' + r'' q'.
/// Where the path would hold the limits A and J up to the rate f (its headroom), |q''| <= A / f^2, |q'''| <= J / f^3,
/// and |q'| <= V. With s = r / f and w = 1 - s^2 both sums stay within A and J, whatever their signs, for
///   |r'| <= 0.95 A / V w, |r'| <= 0.3 J / A w and |r''| <= 0.6 J / V w:
/// 1 - s^3 = w (1 + s^2 / (1 + s)), and 3 s 0.3 + 0.6 is less than that bracket for s in 0..1. Along the bound of r'
/// itself |r''| is 2 r'^2 s / (f w), less than its own bound. Near rate 1 of a fully loaded path w is small: the rate
/// leaves and reaches it exponentially, and a stop takes some 2.8 V / A or 9 A / J; elsewhere a third of that. It is
/// slowed down before a part with less headroom begins: PathNode::headroom_ahead.
class PathClock {
 public:
  static constexpr double kChangeOfAcceleration = 0.95, kChangeOfJerk = 0.3, kRampOfJerk = 0.6;

  /// Limits of r' and r'' if nothing else moves, in any unit of time: the smallest over the axes.
  template <typename Real>
  static constexpr Real change_limit(Real velocity, Real acceleration, Real jerk) {
    return std::min(static_cast<Real>(kChangeOfAcceleration) * (acceleration / velocity),
                    static_cast<Real>(kChangeOfJerk) * (jerk / acceleration));
  }
  template <typename Real>
  static constexpr Real ramp_limit(Real velocity, Real jerk) {
    return static_cast<Real>(kRampOfJerk) * (jerk / velocity);
  }

  /// `change` per sample, `ramp` per sample^2, both in 1..kOneCount. The clock then stands.
  constexpr void configure(Increment change, Increment ramp) {
    constexpr Increment kSlowest = kOneCount >> 24;  // at 20 kHz a ramp of half a minute
    change_limit_ = std::clamp(change, kSlowest, kOneCount);
    ramp_limit_ = std::clamp(ramp, kSlowest >> 8, change_limit_);
    // The way along the bound of r' with the least headroom is f / (2 r'max) ln(1 / w) at most, 1.99 / r'max; w is
    // convex over r^2.
    way_from_full_ = 2 * kOneCount / change_limit_ + 1;
    ramp_samples_ = change_limit_ / ramp_limit_ + 1;
    stand();
  }

  constexpr void set_target(Increment rate) {
    if (rate == target_) return;
    target_ = rate;
    target_ahead_ = kUnknown;
  }
  /// Sets this rate from the next sample on; only while the axes stand, so that no velocity jumps.
  constexpr void begin(Increment rate) {
    rate_ = target_ = rate;
    change_ = 0;
    target_ahead_ = kUnknown;
  }
  constexpr void stand() { begin(0); }

  /// Path time of the next sample, with these headrooms of the path now and until it could be slowed down.
  constexpr Increment next(std::uint32_t here, std::uint32_t ahead) {
    if (is_steady()) return rate_;
    const bool is_downward = target_ < rate_;
    const Increment missing = is_downward ? rate_ - target_ : target_ - rate_;
    const Increment speed = is_downward ? -change_ : change_;  // towards the target
    const std::uint64_t square = square_of(rate_);
    const Increment ramp = limited(ramp_limit_, square, here);
    // The ramps become steeper while slowing down, and gentler while speeding up.
    Increment last_ramp = ramp;
    if (!is_downward) {
      if (ahead != target_ahead_) note_target_ramp(ahead);
      last_ramp = target_ramp_;
    } else if (ahead != here) {
      last_ramp = limited(ramp_limit_, square, ahead);
    }
    Increment wanted = std::min(speed + ramp, limited(change_limit_, square, ahead));
    if (speed < 0)
      wanted = std::min(speed + ramp, Increment{0});
    else if (missing <= last_ramp && speed - missing <= ramp && missing - speed <= ramp)
      wanted = missing;
    else if (!stops_within(missing, wanted, last_ramp))
      wanted = stops_within(missing, speed, last_ramp) ? std::max(speed, std::min(ramp, last_ramp) >> 1) : speed - ramp;
    if (speed > 0) {
      if (wanted < speed - ramp) wanted = speed - ramp;
      if (wanted < 0) wanted = 0;
    }
    change_ = is_downward ? -wanted : wanted;
    rate_ = std::clamp(rate_ + change_, Increment{0}, kOneCount);
    return rate_;
  }

  constexpr Increment rate() const { return rate_; }
  constexpr bool stands() const { return rate_ == 0 && is_steady(); }
  constexpr bool is_steady() const { return rate_ == target_ && change_ == 0; }

  /// Upper bound of the path's samples during a stop from now on, with the smallest headroom throughout.
  constexpr std::int64_t way_of_stop() const {
    const Increment rise = change_ > 0 ? change_ * ramp_samples_ : 0;
    return way_from(std::min(rate_ + rise, kOneCount));
  }
  /// The same from any rate.
  constexpr std::int64_t longest_stop() const { return way_from(kOneCount); }

 private:
  static constexpr std::uint32_t kUnknown = kHeadrooms.size();

  /// 2^-32, up to 1.
  static constexpr std::uint64_t square_of(Increment rate) {
    const auto r = static_cast<std::uint32_t>(rate >> (kFractionBits - 31));
    return std::uint64_t{r} * r >> 30;
  }
  /// limit * w.
  static constexpr Increment limited(Increment limit, std::uint64_t square, std::uint32_t headroom) {
    const auto share = static_cast<std::uint32_t>(square * path_clock::kInverseSquares[headroom] >> 32);
    return path_piece::part_of(limit, ~share, 32);
  }
  [[gnu::noinline]] constexpr void note_target_ramp(std::uint32_t ahead) {
    target_ahead_ = ahead;
    target_ramp_ = limited(ramp_limit_, square_of(target_), ahead);
  }

  /// Whether `missing` suffices for the next samples of v, v - d, v - 2 d, ... : v (v + d) / (2 d), plus an eighth of d
  /// if v is not a multiple of d.
  static constexpr bool stops_within(Increment missing, Increment v, Increment d) {
    constexpr int kShift = kFractionBits - 31;
    const Increment left = missing - (d >> 2);
    if (left < 0) return false;
    const auto first = static_cast<std::uint32_t>(v >> kShift) + 1,
               last = static_cast<std::uint32_t>((v + d) >> kShift) + 1;
    const std::uint64_t needed = std::uint64_t{first} * last;
    return needed <=
           2 * static_cast<std::uint64_t>(path_piece::part_of(d, static_cast<std::uint32_t>(left >> kShift), kShift));
  }

  /// Twice ramp_samples_ pass until the clock slows down as quickly as allowed, and once ramp_samples_ at the end.
  constexpr std::int64_t way_from(Increment rate) const {
    const auto r = static_cast<std::uint32_t>(rate >> (kFractionBits - 31));
    const std::int64_t along = path_piece::part_of(way_from_full_, r, 31) + 3 * ramp_samples_;
    return path_piece::part_of(along, r, 31) + 2;
  }

  Increment rate_ = 0, change_ = 0, target_ = 0;
  Increment change_limit_ = 1, ramp_limit_ = 1;
  Increment target_ramp_ = 0;  ///< at the target, with this headroom
  std::uint32_t target_ahead_ = kUnknown;
  std::int64_t way_from_full_ = 0, ramp_samples_ = 0;  ///< samples
};

}  // namespace firmware
