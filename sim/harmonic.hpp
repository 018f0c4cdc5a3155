// One sine over the travel.
#pragma once

#include <cmath>
#include <numbers>

namespace sim {

/// cos(2 pi turns), within 1e-13: folded to a quarter turn about the nearest zero of the cosine, then the sine's
/// series, whose first missing term is (pi/2)^19/19!. Terms in groups: shorter chains.
inline double cosine_of_turns(double turns) {
  constexpr double kRounder = 0x1.8p52;  // adding 1.5 * 2^52 rounds to a whole number
  const double fraction = turns - ((turns + kRounder) - kRounder);
  const double a = 2.0 * std::numbers::pi * (0.25 - std::abs(fraction));
  const double aa = a * a, a4 = aa * aa, a8 = a4 * a4;
  const double low = (1.0 - aa * (1.0 / 6)) + a4 * (1.0 / 120 - aa * (1.0 / 5040));
  const double high = (1.0 / 362880 - aa * (1.0 / 39916800)) + a4 * (1.0 / 6227020800.0 - aa * (1.0 / 1307674368e3));
  return a * (low + a8 * (high + a8 * (1.0 / 355687428096e3)));
}

/// cosine * cos(2 pi x / period) + sine * sin(2 pi x / period); the constructor's period must not be 0.
class Harmonic {
 public:
  Harmonic(double cosine, double sine, double period)
      : amplitude_(std::hypot(cosine, sine)),
        phase_(std::atan2(sine, cosine) / (2.0 * std::numbers::pi)),
        per_travel_(1.0 / period) {}

  double operator()(double x) const { return amplitude_ * cosine_of_turns(x * per_travel_ - phase_); }

 private:
  double amplitude_, phase_, per_travel_;
};

}  // namespace sim
