// The functions of exponential integrators: exact steps of v' = f + lambda (v - v0).
#pragma once

#include <cmath>

#include "sim/decay.hpp"

namespace sim {

/// Functions for a step of length h at z = lambda h: phi1 = (e^z - 1)/z and phi2 = (phi1 - 1)/z.
struct ExponentialFactors {
  double phi1;
  double phi2;
};

/// Computed by the definition, for z well away from zero.
[[gnu::noinline, gnu::cold]] inline ExponentialFactors exponential_factors_far_from_zero(double z) {
  const double phi1 = std::expm1(z) / z;
  return {phi1, (phi1 - 1.0) / z};
}

[[gnu::always_inline]] inline ExponentialFactors exponential_factors(double z) {
  // Below 1/8 the first missing term of the series, z^6/40320, is under 1e-10. Terms in groups: shorter chains.
  if (std::abs(z) > 0.125) return exponential_factors_far_from_zero(z);
  const double zz = z * z;
  const double phi2 =
      (1.0 / 2 + z * (1.0 / 6)) + zz * ((1.0 / 24 + z * (1.0 / 120)) + zz * (1.0 / 720 + z * (1.0 / 5040)));
  return {1.0 + z * phi2, phi2};
}

/// Exact mean over `duration` of a first-order lag that starts at `value` and follows a constant `target`; moves
/// `value`.
inline double lag_mean(double& value, double target, double time_constant, double duration) {
  const double z = duration / time_constant;
  const double gap = value - target, left = decay(z);
  value = target + gap * left;
  return target + gap * (z > 0.125 ? (1.0 - left) / z : exponential_factors(-z).phi1);
}

/// Time at which v0 + t phi1(lambda t) f reaches zero, for v0 > 0 and f < 0; +infinity if it never does.
inline double time_to_zero(double v0, double f, double lambda) {
  const double ratio = -lambda * v0 / f;
  if (std::abs(ratio) < 1e-8) return -v0 / f;
  if (ratio <= -1.0) return HUGE_VAL;
  return std::log1p(ratio) / lambda;
}

}  // namespace sim
