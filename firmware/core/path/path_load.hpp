// Load of a piece of a path on its axes, from its geometry: speed, acceleration, travel, and the remainder for a
// changing clock.
#pragma once

#include <algorithm>
#include <array>

#include "firmware/core/arithmetic/scalar.hpp"
#include "firmware/core/path/path_headroom.hpp"
#include "firmware/core/path/path_piece.hpp"

namespace firmware {

/// Limits of one axis, in counts and samples.
struct PathLimits {
  float velocity = 0, acceleration = 0, jerk = 0;
};

/// Load of one piece, as parts of the limits; travel in counts from its beginning.
template <std::size_t axes>
struct PathLoad {
  float velocity = 0, acceleration = 0;  ///< largest of all axes
  /// Part of its limit that a change of the clock may use at rate 1: PathClock's w there, 0 to 1.
  float left = 1;
  std::array<float, axes> least{}, most{};

  /// Index into kHeadrooms of the headroom that leaves this part.
  std::uint8_t headroom() const {
    std::uint8_t number = 0;
    while (number + 1u < kHeadrooms.size() && kLeft[number + 1u] <= left) ++number;
    return number;
  }

 private:
  /// 1 - 1 / f^2.
  static constexpr std::array<float, kHeadrooms.size()> kLeft = [] {
    std::array<float, kHeadrooms.size()> all{};
    for (std::size_t i = 0; i < all.size(); ++i)
      all[i] = static_cast<float>(1.0 - 1.0 / (kHeadrooms[i] * kHeadrooms[i]));
    return all;
  }();
};

/// At kPoints + 1 places of the piece, evenly spaced. An axis has the velocity x V, the acceleration y A and the jerk
/// z J there. A clock at rate 1 adds r' x V to the acceleration and 3 r' y A + r'' x V to the jerk; with the bounds
/// of r' and r'' that PathClock has, 0.95 A / V w, 0.3 J / A w and 0.6 J / V w, both hold for
///   w <= (1 - y) / x and w <= (1 - z) / (0.9 y + 0.6 x).
/// x and y are taken at the same place, because on a circle an axis is fast where it does not accelerate. Below rate 1
/// the bound 1 - (1 - w) r^2 is a chord of the allowed value, which is concave in r^2, so the bound is below it.
///
/// `mask`: axes of the path. Divides: for the background.
template <std::size_t axes>
constexpr PathLoad<axes> path_load(const PathPiece<axes>& piece, unsigned mask,
                                   const std::array<PathLimits, axes>& limits) {
  constexpr int kPoints = 16;
  PathLoad<axes> load;
  const float samples = ScalarTraits<float>::from_increment(piece.duration());
  const float rate = 1.0F / samples;
  for (std::size_t i = 0; i < axes; ++i) {
    if ((mask >> i & 1u) == 0) continue;
    const PathLimits& limit = limits[i];
    const std::array<float, 5> c = piece.coefficients(i);
    const float velocity_share = rate / limit.velocity, acceleration_share = rate * rate / limit.acceleration,
                jerk_share = rate * rate * rate / limit.jerk;
    float sharpest = 0;
    for (int k = 0; k <= kPoints; ++k) {
      const float t = static_cast<float>(k) * (1.0F / kPoints);
      const float way = t * (c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * c[4]))));
      const float first = c[0] + t * (2 * c[1] + t * (3 * c[2] + t * (4 * c[3] + t * 5 * c[4])));
      const float second = 2 * c[1] + t * (6 * c[2] + t * (12 * c[3] + t * 20 * c[4]));
      const float third = 6 * c[2] + t * (24 * c[3] + t * 60 * c[4]);
      using Traits = ScalarTraits<float>;
      const float x = Traits::magnitude(first) * velocity_share, y = Traits::magnitude(second) * acceleration_share,
                  z = Traits::magnitude(third) * jerk_share;
      load.velocity = std::max(load.velocity, x);
      load.acceleration = std::max(load.acceleration, y);
      sharpest = std::max(sharpest, Traits::magnitude(second));
      if (1 - y < load.left * x) load.left = y < 1 ? (1 - y) / x : 0;
      const float of_jerk = 0.9F * y + 0.6F * x;
      if (1 - z < load.left * of_jerk) load.left = z < 1 ? (1 - z) / of_jerk : 0;
      load.least[i] = std::min(load.least[i], way);
      load.most[i] = std::max(load.most[i], way);
    }
    // Largest deviation between two places.
    const float unseen = sharpest * (1.0F / (8 * kPoints * kPoints));
    if (load.least[i] < 0) load.least[i] -= unseen;
    if (load.most[i] > 0) load.most[i] += unseen;
  }
  return load;
}

}  // namespace firmware
