// Friction feed-forward: eq. (19), driven by the reference velocity and continuous through zero.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/core/arithmetic/exp_negative.hpp"

namespace firmware {

/// The friction curve of one direction of motion. All values are magnitudes (not negative), for both directions alike;
/// volts are torque or force divided by Ka*Kt (Nm/V) or by the force constant (N/V).
template <typename Scalar>
struct FrictionDirection {
  Scalar static_V{};
  Scalar coulomb_V{};
  Scalar viscous_V_s_per_rad{};  ///< V per rad/s (V per m/s), added to what the drive model already contains
  Scalar omega1_rad_s{};         ///< rad/s (m/s); 0: static friction ends as soon as the axis moves
  Scalar omega2_rad_s{};         ///< rad/s (m/s); 0: Coulomb friction acts as soon as the axis moves
};

template <typename Scalar>
struct FrictionParameters {
  FrictionDirection<Scalar> positive{};
  FrictionDirection<Scalar> negative{};
  /// Below this speed the output falls in proportion to speed, so that it is continuous and 0 at rest; > 0.
  Scalar blend_velocity_rad_s{};
};

/// A point of eq. (19) itself.
template <typename Scalar>
struct FrictionPoint {
  Scalar level_V{}, slope_V_s_per_rad{};
};

/// Eq. (19) from a speed >= 0 on, in equal steps. An exponential decays by the same factor in each step. That needs one
/// multiplication; the function itself also needs a division, for which a processor without FPU has no time. Rounding
/// errors add up: if the omegas are within a factor of fifty, 34 points are within 6e-7 of the level in float, within
/// 1.1e-5 in fixed point.
template <typename Scalar>
class FrictionSteps {
 public:
  constexpr FrictionSteps(const FrictionDirection<Scalar>& side, Scalar begin, Scalar width)
      : side_(side),
        speed_(begin),
        width_(width),
        first_(side.static_V, side.omega1_rad_s, begin, width),
        second_(side.coulomb_V, side.omega2_rad_s, begin, width) {}

  constexpr FrictionPoint<Scalar> next() {
    const FrictionPoint<Scalar> point = {
        side_.static_V * first_.share + side_.coulomb_V * (Scalar(1) - second_.share) +
            side_.viscous_V_s_per_rad * speed_,
        second_.rate * second_.share - first_.rate * first_.share + side_.viscous_V_s_per_rad};
    speed_ = speed_ + width_;
    first_.share = first_.share * first_.factor;
    second_.share = second_.share * second_.factor;
    return point;
  }

 private:
  struct Decay {
    constexpr Decay(Scalar level, Scalar omega, Scalar begin, Scalar width) {
      if (!(omega > Scalar(0))) return;
      share = exp_negative(begin / omega);
      factor = exp_negative(width / omega);
      rate = level / omega;
    }
    Scalar share{}, factor{};  ///< present share of the level; factor on it per step
    Scalar rate{};             ///< slope as a share of the level per rad/s
  };

  const FrictionDirection<Scalar>& side_;
  Scalar speed_, width_;
  Decay first_, second_;
};

/// The curve as cubic pieces with its values and slopes at their ends: narrow pieces up to eight times the smaller
/// omega, where exp(-8) = 3e-4 of its exponential remains; wide ones up to sixteen times the larger; a straight line
/// beyond, where exp(-16) = 1e-7 remains. A piece spans at most a quarter or half of the dominant omega, so its error
/// is at most h^4/384: 1.7e-4 of the level, half a step of the converter at 1 V. That holds for omegas within a factor
/// of ten; at a factor of fifty the error is a thousandth of the level.
template <typename Scalar>
class FrictionPieces {
 public:
  constexpr void configure(const FrictionDirection<Scalar>& side) {
    side_ = side;
    const Scalar a = side.omega1_rad_s > Scalar(0) ? side.omega1_rad_s : side.omega2_rad_s;
    const Scalar b = side.omega2_rad_s > Scalar(0) ? side.omega2_rad_s : a;
    const Scalar smaller = a < b ? a : b;
    const Scalar larger = a < b ? b : a;
    narrow_end_ = smaller * Scalar(8);
    wide_end_ = larger * Scalar(16);
    fill(0, Scalar(0), narrow_end_, narrow_per_speed_);
    fill(kNarrow, narrow_end_, wide_end_, wide_per_speed_);
  }

  constexpr Scalar operator()(Scalar speed) const {
    if (speed < narrow_end_) return piece(0, speed * narrow_per_speed_);
    if (speed < wide_end_) return piece(kNarrow, (speed - narrow_end_) * wide_per_speed_);
    return side_.coulomb_V + side_.viscous_V_s_per_rad * speed;
  }

 private:
  static constexpr std::int32_t kNarrow = 32, kWide = 32;
  using Cubic = std::array<Scalar, 4>;

  /// Pieces of equal width from `begin` to `end`, each over a variable from 0 to 1, and one more, because rounding may
  /// put a speed just beyond the last.
  constexpr void fill(std::int32_t first, Scalar begin, Scalar end, Scalar& per_speed) {
    const std::int32_t number = first == 0 ? kNarrow : kWide;
    const Scalar width = (end - begin) / ScalarTraits<Scalar>::from_integer(number);
    if (!(width > Scalar(0))) return;
    per_speed = Scalar(1) / width;
    FrictionSteps<Scalar> steps(side_, begin, width);
    FrictionPoint<Scalar> from = steps.next();
    for (std::int32_t i = 0; i <= number; ++i) {
      const FrictionPoint<Scalar> to = steps.next();
      const Scalar f0 = from.level_V, rise = to.level_V - f0;
      const Scalar s0 = from.slope_V_s_per_rad * width, s1 = to.slope_V_s_per_rad * width;
      piece_[static_cast<std::size_t>(first) + static_cast<std::size_t>(i)] = {
          f0, s0, Scalar(3) * rise - Scalar(2) * s0 - s1, s0 + s1 - Scalar(2) * rise};
      from = to;
    }
  }

  constexpr Scalar piece(std::int32_t first, Scalar place) const {
    const std::int32_t number = ScalarTraits<Scalar>::truncate(place);
    const Scalar t = place - ScalarTraits<Scalar>::from_integer(number);
    const Cubic& c = piece_[static_cast<std::size_t>(first) + static_cast<std::size_t>(number)];
    return ((c[3] * t + c[2]) * t + c[1]) * t + c[0];
  }

  FrictionDirection<Scalar> side_{};
  Scalar narrow_end_{}, wide_end_{}, narrow_per_speed_{}, wide_per_speed_{};
  std::array<Cubic, kNarrow + kWide + 1> piece_{};
};

template <typename Scalar>
class FrictionFeedforward {
 public:
  constexpr void configure(const FrictionParameters<Scalar>& parameters) {
    blend_velocity_ = parameters.blend_velocity_rad_s;
    positive_.configure(parameters.positive);
    negative_.configure(parameters.negative);
    positive_slope_ = positive_(blend_velocity_) / blend_velocity_;
    negative_slope_ = negative_(blend_velocity_) / blend_velocity_;
  }

  /// Volts that overcome friction at the reference velocity (rad/s or m/s); the sign is that of the velocity.
  constexpr Scalar operator()(Scalar reference_velocity) const {
    if (reference_velocity >= blend_velocity_) return positive_(reference_velocity);
    if (reference_velocity > Scalar(0) - blend_velocity_)
      return reference_velocity * (reference_velocity > Scalar(0) ? positive_slope_ : negative_slope_);
    return Scalar(0) - negative_(Scalar(0) - reference_velocity);
  }

  /// The same without the blending: it jumps at speed 0, where it is 0.
  constexpr Scalar without_blend(Scalar reference_velocity) const {
    if (reference_velocity > Scalar(0)) return positive_(reference_velocity);
    return reference_velocity == Scalar(0) ? Scalar(0) : Scalar(0) - negative_(Scalar(0) - reference_velocity);
  }

 private:
  FrictionPieces<Scalar> positive_{};
  FrictionPieces<Scalar> negative_{};
  Scalar blend_velocity_{};
  Scalar positive_slope_{};
  Scalar negative_slope_{};
};

}  // namespace firmware
