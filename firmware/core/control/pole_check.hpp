// Checks the poles of the sampled estimator and loop: whether a set of gains may close a loop.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/core/axis_parameters.hpp"
#include "firmware/core/control/filter_loop.hpp"

namespace firmware {

enum class PoleProblem : std::uint8_t {
  none,
  unstable,  ///< a pole on or outside the unit circle; gains of zero leave one on it
  undamped,  ///< a pair with less damping than kLeastDamping, or a pole that rings at half the sampling rate
  slow,      ///< a mode that takes longer than kLongestMode_s, so that the error drifts away meanwhile
};

/// Least damping of a pair of poles, after the bilinear map s = (z - 1) / (z + 1). For a pair that is slow compared
/// with the sample rate, it is the damping of the continuous pair.
inline constexpr float kLeastDamping = 0.1f;
/// A negative real pole, and the radius of a pair with a negative real part: after ten samples less than a fifth of
/// such an oscillation may remain.
inline constexpr float kFastestRinging = 0.85f;
/// Four times the monitors' load time.
inline constexpr float kLongestMode_s = 4.0f * kLoadTime_s;

/// Characteristic polynomials in delta = z - 1. At a fast control rate the poles are close to z = 1, where coefficients
/// in z cancel in single precision; as powers of delta they keep their precision.
namespace poles {

/// delta^2 + linear delta + constant
struct Quadratic {
  float linear, constant;
};
/// delta^3 + square delta^2 + linear delta + constant
struct Cubic {
  float square, linear, constant;
  constexpr float at(float delta) const { return ((delta + square) * delta + linear) * delta + constant; }
};

template <typename Scalar>
constexpr float real(Scalar value) {
  return ScalarTraits<Scalar>::to_float(value);
}

/// Of state feedback: A - B Kc on position and velocity.
template <typename Scalar>
constexpr Quadratic of_loop(const AxisParameters<Scalar>& p) {
  const float a12 = real(p.drive.Ad12), decay = real(Scalar(1) - p.drive.Ad22);
  const float b1 = real(p.drive.Bd1), b2 = real(p.drive.Bd2), k1 = real(p.Kc[0]), k2 = real(p.Kc[1]);
  return {.linear = b1 * k1 + b2 * k2 + decay, .constant = k1 * (b1 * decay + b2 * a12)};
}

/// Of the estimator's error: (I - Kobs C) A, eqs. (16) and (43); without a tachometer its column does not act.
template <typename Scalar>
constexpr Cubic of_estimator(const AxisParameters<Scalar>& p) {
  const float a12 = real(p.drive.Ad12), decay = real(Scalar(1) - p.drive.Ad22);
  const float b1 = real(p.drive.Bd1), b2 = real(p.drive.Bd2);
  float m[3][3] = {{0, a12, -b1}, {0, -decay, -b2}, {0, 0, 0}};  // A - I, less Kobs C A
  for (std::size_t row = 0; row < 3; ++row) {
    const float encoder = real(p.Kobs[row][0]), tachometer = p.tachometer_fitted ? real(p.Kobs[row][1]) : 0.0f;
    m[row][0] -= encoder;
    m[row][1] -= encoder * a12 + tachometer * (1.0f - decay);
    m[row][2] += encoder * b1 + tachometer * b2;
  }
  const auto minor = [&](int i, int j) { return m[i][i] * m[j][j] - m[i][j] * m[j][i]; };
  const float determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                            m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                            m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  return {.square = -(m[0][0] + m[1][1] + m[2][2]),
          .linear = minor(0, 1) + minor(0, 2) + minor(1, 2),
          .constant = -determinant};
}

/// `least`: smallest relative decay of a mode in one sample.
constexpr PoleProblem check(const Quadratic& q, float least) {
  const float trace = 2.0f - q.linear, product = 1.0f - q.linear + q.constant;  // of z
  const float at_minus_one = 4.0f - 2.0f * q.linear + q.constant;
  if (!(q.constant > 0.0f && at_minus_one > 0.0f && product < 1.0f && product > -1.0f)) return PoleProblem::unstable;
  const bool is_pair = q.linear * q.linear < 4.0f * q.constant;
  if (is_pair) {
    const float lost = q.linear - q.constant;  // 1 - product
    if (lost * lost < kLeastDamping * kLeastDamping * at_minus_one * q.constant) return PoleProblem::undamped;
    if (trace < 0.0f && product > kFastestRinging * kFastestRinging) return PoleProblem::undamped;
    return lost < 2.0f * least ? PoleProblem::slow : PoleProblem::none;
  }
  const float at_ringing = kFastestRinging * (kFastestRinging + trace) + product;
  if (!(at_ringing > 0.0f && trace > -2.0f * kFastestRinging)) return PoleProblem::undamped;
  return q.constant < least * (q.linear - least) || q.linear < 2.0f * least ? PoleProblem::slow : PoleProblem::none;
}

/// The real root between z = -1 and z = 1 by forty bisections, then the remaining pair.
constexpr PoleProblem check(const Cubic& c, float least) {
  float lower = -2.0f, upper = 0.0f;
  if (!(c.at(lower) < 0.0f && c.at(upper) > 0.0f)) return PoleProblem::unstable;
  for (int halving = 0; halving < 40; ++halving) {
    const float middle = (lower + upper) * 0.5f;
    (c.at(middle) < 0.0f ? lower : upper) = middle;
  }
  if (!(upper < 0.0f)) return PoleProblem::unstable;
  const PoleProblem pair = check(Quadratic{.linear = c.square + upper, .constant = -c.constant / upper}, least);
  if (pair == PoleProblem::unstable || pair == PoleProblem::undamped) return pair;
  if (1.0f + upper < -kFastestRinging) return PoleProblem::undamped;
  return -upper < least ? PoleProblem::slow : pair;
}

}  // namespace poles

/// `p` has passed check(). Computes in single precision for any scalar: for the background.
template <typename Scalar>
constexpr PoleProblem estimator_problem(const AxisParameters<Scalar>& p) {
  return poles::check(poles::of_estimator(p), poles::real(p.monitors.load_share) * (kLoadTime_s / kLongestMode_s));
}
template <typename Scalar>
constexpr PoleProblem loop_problem(const AxisParameters<Scalar>& p) {
  return poles::check(poles::of_loop(p), poles::real(p.monitors.load_share) * (kLoadTime_s / kLongestMode_s));
}

/// All roots of the loop's characteristic polynomial with filters are within the circle of the loop's own decay over
/// kSlowerWithFilters (filter_loop.hpp): no mode may take that many times longer than the loop without filters.
template <typename Scalar>
[[gnu::noinline]] constexpr bool settles_with_filters(const AxisParameters<Scalar>& p) {
  constexpr float kSlowerWithFilters = 10.0f;
  const poles::Quadratic loop = poles::of_loop(p);
  const float decay = poles::real(Scalar(1) - p.drive.Ad22);
  const float a12 = poles::real(p.drive.Ad12), b1 = poles::real(p.drive.Bd1), b2 = poles::real(p.drive.Bd2);
  FilterLoop joined({0.0f, decay, 1.0f}, {poles::real(p.Kc[0]) * (b1 * decay + a12 * b2),
                                          poles::real(p.Kc[0]) * b1 + poles::real(p.Kc[1]) * b2, 0.0f});
  for (const BiquadParameters<Scalar>& filter : p.filters)
    if (filter.on)
      joined.add(poles::real(filter.a1), poles::real(filter.a2), poles::real(filter.of_band), filter.is_low_pass);
  // A pair loses half of 1 - z1 z2 a sample.
  return joined.settles(0.5f * (loop.linear - loop.constant) / kSlowerWithFilters);
}

/// A filter that is switched on has valid parameters, and the loop is stable with it.
template <typename Scalar>
constexpr bool are_filters_sound(const AxisParameters<Scalar>& p) {
  bool is_on = false;
  for (const BiquadParameters<Scalar>& filter : p.filters) {
    if (!filter.on) continue;
    is_on = true;
    if (!(filter.a1 > Scalar(0) && filter.a3 > Scalar(0) && ScalarTraits<Scalar>::is_finite(filter.of_band)))
      return false;
  }
  return !is_on || settles_with_filters(p);
}

template <typename Scalar>
constexpr Refusal check_poles(const AxisParameters<Scalar>& p) {
  if (estimator_problem(p) != PoleProblem::none) return Refusal::estimator_poles;
  if (loop_problem(p) != PoleProblem::none) return Refusal::loop_poles;
  return are_filters_sound(p) ? Refusal::none : Refusal::filters;
}

}  // namespace firmware
