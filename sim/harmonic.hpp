// Sines over the travel: the orders of one period.
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "sim/drive_description.hpp"

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

/// One order of a period: cosine * cos(2 pi order x / period) + sine * sin(...).
struct HarmonicTerm {
  double order = 1.0;
  double cosine = 0.0;
  double sine = 0.0;
};

/// The id of an order's amplitude: the family itself ("cosine") for the first order, numbered for all others.
std::string harmonic_id(std::string_view family, double order);

/// The orders of a periodic effect's entry, lowest first.
std::vector<HarmonicTerm> harmonics_of(const EffectEntry& entry);

/// Writes the orders into an entry: the first order alone as the pair `cosine`, `sine`, all others numbered.
void set_harmonics(EffectEntry& entry, const std::vector<HarmonicTerm>& terms);

/// The sum of an entry's orders. The entry's period must not be 0.
class Harmonics {
 public:
  explicit Harmonics(const EffectEntry& entry);

  double operator()(double x) const {
    double sum = 0.0;
    for (const Wave& wave : waves_) sum += wave.amplitude * cosine_of_turns(x * wave.per_travel - wave.phase);
    return sum;
  }
  /// The shortest period among its orders, mm or m.
  double finest_period() const { return finest_period_; }

 private:
  struct Wave {
    double amplitude, phase, per_travel;  ///< phase in turns; turns per mm or m
  };
  std::vector<Wave> waves_;
  double finest_period_;
};

}  // namespace sim
