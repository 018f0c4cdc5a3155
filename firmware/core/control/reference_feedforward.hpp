// Feed-forward of the reference: either its velocity alone (eqs. 50, 52), or zero phase error tracking.
#pragma once

#include <array>

#include "firmware/core/control/discrete_drive.hpp"

namespace firmware {

/// Kc of eq. (51): V/mm, V per rad/s (V/m, V per m/s).
template <typename Scalar>
using StateFeedbackGain = std::array<Scalar, 2>;

/// Samples of the reference beyond the present one that feed-forward needs.
inline constexpr int kPreviewSamples = 2;

/// Weights of the reference velocity and of its changes in the samples to come, in V per rad/s, where
/// w(k) = (x(k) - x(k-1)) / (lead Ts). The control law is
///     u = Kc1 (xref(k) - x) - Kc2 w + velocity * wref(k) + sum of change[i] * (wref(k+i+1) - wref(k+i)).
/// Weights of wref(k), wref(k+1), wref(k+2) would give the same law, but they are large and of opposite signs: at speed
/// their products exceed the range of fixed point and lose precision in float.
template <typename Scalar>
struct ReferenceFeedforward {
  Scalar velocity{};
  std::array<Scalar, kPreviewSamples> change{};
};

/// Eq. (50) with the reference velocity of eq. (52).
template <typename Scalar>
constexpr ReferenceFeedforward<Scalar> backward_difference_feedforward(const StateFeedbackGain<Scalar>& Kc) {
  return {Kc[1], {}};
}

/// Zero phase error tracking control (Tomizuka 1987) for the loop that state feedback closes.
///
/// With u = v - Kc1 x - Kc2 w, position answers v as
///     x/v = (n1 z + n0) / (z^2 + d1 z + d0) = z^-1 N(z^-1) / D(z^-1),   N = n1 + n0 z^-1,  D = 1 + d1 z^-1 + d0 z^-2,
///     n1 = Bd1,  n0 = Ad12 Bd2 - Ad22 Bd1  (feedback leaves zeros where they are),
///     d1 = -(trace of Ad - Bd Kc),  d0 = its determinant.
/// The zero -n0/n1 lies just inside -1 for a drive whose time constant is long compared with Ts: cancelling it would
/// make the output oscillate at the Nyquist frequency. So only D is cancelled, and N gets zero phase: with N(z) the
/// same polynomial in z,
///     v(k) = D(z^-1) N(z) / N(1)^2 xref(k+1)   gives   x/xref = N(z) N(z^-1) / N(1)^2,
/// which is real, positive and 1 at standstill: 1 - 2 n0 n1 (1 - cos(omega Ts)) / (n0 + n1)^2. It is a filter of four
/// taps on xref(k+2) .. xref(k-1) with no memory of its own:
///     c(+2) = n0, c(+1) = n1 + d1 n0, c(0) = d1 n1 + d0 n0, c(-1) = d0 n1, all / (n0 + n1)^2.
/// Its taps add up to D(1)/N(1) = Kc1, hence v(k) - Kc1 xref(k) depends on differences of the reference only, that is
/// on reference velocities, and no position in millimetres is ever multiplied by a gain.
///
/// The weight of wref(k) is the sum of all weights. At a steady velocity x = xref, so this weight is, on travel,
///     (Kc2 + h) / (Ad12 + Bd1 h),   h = (1 - Ad22) / Bd2, the volts that keep a velocity.
template <typename Scalar>
constexpr ReferenceFeedforward<Scalar> zero_phase_feedforward(const DiscreteDrive<Scalar>& drive,
                                                              const StateFeedbackGain<Scalar>& Kc,
                                                              Scalar travel_per_velocity) {
  const Scalar n1 = drive.Bd1;
  const Scalar n0 = drive.Ad12 * drive.Bd2 - drive.Ad22 * drive.Bd1;
  const Scalar a11 = Scalar(1) - drive.Bd1 * Kc[0];
  const Scalar a22 = drive.Ad22 - drive.Bd2 * Kc[1];
  const Scalar d1 = Scalar(0) - (a11 + a22);
  const Scalar sum = n0 + n1;  // divided by twice: its square is small, and would lose digits in fixed point
  const Scalar tap_plus2 = n0 / sum / sum * travel_per_velocity;
  const Scalar tap_plus1 = (n1 + d1 * n0) / sum / sum * travel_per_velocity;
  const Scalar hold = (Scalar(1) - drive.Ad22) / drive.Bd2;
  const Scalar steady = (Kc[1] + hold) / (drive.Ad12 + drive.Bd1 * hold);
  return {steady * travel_per_velocity, {tap_plus1 + tap_plus2 + tap_plus2, tap_plus2}};
}

}  // namespace firmware
