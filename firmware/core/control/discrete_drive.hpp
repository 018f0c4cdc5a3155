// The rigid drive, sampled: eq. (7) with position, velocity, control volts and an equivalent disturbance in volts.
#pragma once

namespace firmware {

/// x(k+1) = x(k) + Ad12 w(k) + Bd1 (u(k) - d(k)),  w(k+1) = Ad22 w(k) + Bd2 (u(k) - d(k)).
/// Rotary drives: x in mm, w in rad/s. Linear drives: x in m, w in m/s. With the disturbance as third state (eq. 16),
/// A = [1 Ad12 -Bd1; 0 Ad22 -Bd2; 0 0 1] and B = [Bd1; Bd2; 0].
template <typename Scalar>
struct DiscreteDrive {
  Scalar Ad12{};  ///< mm per rad/s (s): lead * (1 - e^(pw Ts)) / -pw
  Scalar Ad22{};  ///< 1, in (0, 1]: e^(pw Ts)
  Scalar Bd1{};   ///< mm/V (m/V), > 0
  Scalar Bd2{};   ///< rad/s/V (m/s/V), > 0
};

}  // namespace firmware
