// The functions of exponential integrators: exact steps of v' = f + lambda (v - v0).
#pragma once

#include <cmath>

namespace sim {

/// Below this |z| the series are used: their first missing term, z^6/40320, is then under 1e-10.
inline constexpr double kSeriesReach = 0.125;

/// (e^z - 1)/z.
inline double phi1(double z) {
  if (std::abs(z) > kSeriesReach) return std::expm1(z) / z;
  return 1.0 + z * (1.0 / 2 + z * (1.0 / 6 + z * (1.0 / 24 + z * (1.0 / 120 + z * (1.0 / 720 + z / 5040)))));
}

/// (phi1(z) - 1)/z.
inline double phi2(double z) {
  if (std::abs(z) > kSeriesReach) return (phi1(z) - 1.0) / z;
  return 1.0 / 2 + z * (1.0 / 6 + z * (1.0 / 24 + z * (1.0 / 120 + z * (1.0 / 720 + z / 5040))));
}

/// Time at which v0 + t phi1(lambda t) f reaches zero, for v0 > 0 and f < 0; +infinity where it never does.
inline double time_to_zero(double v0, double f, double lambda) {
  const double ratio = -lambda * v0 / f;
  if (std::abs(ratio) < 1e-8) return -v0 / f;
  if (ratio <= -1.0) return HUGE_VAL;
  return std::log1p(ratio) / lambda;
}

}  // namespace sim
