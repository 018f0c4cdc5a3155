// Motion of one mass on elastic bristles (LuGre: Canudas de Wit et al., IEEE TAC 40(3), 1995):
//   J dw/dt = T - sigma0 z - sigma1 dz/dt - B w,   dz/dt = w - sigma0 |w| z / g(w),
// where g(w) is the curve of eq. (19) without its viscous term.
#pragma once

#include <algorithm>
#include <cmath>

#include "sim/friction.hpp"

namespace sim {

/// Longest step: half a radian of the oscillation of the mass on its bristles, which the scheme slows by 0.03 % and
/// damps by 0.1 % per step; at most 1 ms. Not below 20 us: stiffer contacts deflect by nanometres only.
inline double presliding_step_s(const Bristles& bristles, double inertia) {
  return std::clamp(0.5 * std::sqrt(inertia / bristles.stiffness), 20e-6, 1e-3);
}

/// A mass on its bristles through steps of `h` under a constant effort, linearly implicit and of order 2:
/// y += h phi1(Z) f with Z = h times the Jacobian. phi1 = (I - Z/6) / (I - 2 Z/3 + Z^2/6) corresponds to the (1, 2)
/// Pade approximation of the exponential, which is L-stable.
template <typename Contact>
struct MassOnBristles {
  const Bristles& bristles;
  double mobility, effort, h;
  const Contact& contact;
  double w, z;
  double speeds = 0.0;  ///< twice the sum of the steps' mean speeds

  /// With `kChecked`: false, with the mass unchanged, if it reverses or its friction level changes too much for a
  /// linear approximation.
  template <bool kChecked>
  [[gnu::always_inline]] bool step() {
    const double stiffness = bristles.stiffness, damping = bristles.damping * mobility;
    const int side = w >= 0.0 ? 0 : 1;
    const double sign = w >= 0.0 ? 1.0 : -1.0, speed = std::abs(w);
    const FrictionPoint dry = contact.dry(side, speed), viscous = contact.viscous(side, speed);
    const double level = std::max(dry.effort, 1e-9), per_level = 1.0 / level;
    const double bent = stiffness * per_level * z;  // relative to the deflection in steady sliding

    const double z_rate = w - speed * bent;
    const double w_rate = (effort - stiffness * z - sign * viscous.effort) * mobility - damping * z_rate;
    // The Jacobian of both derivatives over w and z, times h.
    const double zz = -h * stiffness * speed * per_level;
    const double zw = h * (1.0 - sign * bent * (1.0 - speed * dry.slope * per_level));
    const double ww = -h * viscous.slope * mobility - damping * zw;
    const double wz = -h * stiffness * mobility - damping * zz;

    // Z^2 = trace Z - determinant I.
    constexpr double kSixth = 1.0 / 6.0;
    const double alike = 1.0 - kSixth * (ww * zz - wz * zw), times = kSixth * (ww + zz) - 4.0 * kSixth;
    const double right_w = w_rate - kSixth * (ww * w_rate + wz * z_rate);
    const double right_z = z_rate - kSixth * (zw * w_rate + zz * z_rate);
    const double a = alike + times * ww, b = times * wz, c = times * zw, d = alike + times * zz;
    const double h_per_determinant = h / (a * d - b * c);
    const double faster = h_per_determinant * (d * right_w - b * right_z), end = w + faster;
    constexpr double kMostChange = 0.03;
    if (kChecked && (end * w < 0.0 || std::abs(dry.slope * faster) > kMostChange * level)) return false;
    // The deflection of a bristle stays below 1.5 times that of steady sliding.
    const double most = 1.5 / stiffness * level;
    z = std::clamp(z + h_per_determinant * (a * right_z - c * right_w), -most, most);
    speeds += w + end;
    w = end;
    return true;
  }
};

/// Moves both for `parts` steps of `duration_s` each under a constant effort; halves a step if necessary.
template <typename Contact>
[[gnu::noinline]] void move_on_bristles_in_short_steps(const Bristles& bristles, double mobility, double lead,
                                                       DriveMotion& motion, double effort, double duration_s, int parts,
                                                       const Contact& contact) {
  MassOnBristles<Contact> mass{bristles, mobility, effort, 0.5 * duration_s, contact, motion.w, motion.bristle};
  for (int half = 0; half < 2 * parts; ++half) mass.template step<false>();
  motion.x += lead * 0.5 * mass.h * mass.speeds;
  motion.w = mass.w;
  motion.bristle = mass.z;
}

template <typename Contact>
[[gnu::always_inline]] inline void move_on_bristles(const Bristles& bristles, double mobility, double lead,
                                                    DriveMotion& motion, double effort, double duration_s, int parts,
                                                    const Contact& contact) {
  MassOnBristles<Contact> mass{bristles, mobility, effort, duration_s, contact, motion.w, motion.bristle};
  int done = 0;
  while (done < parts && mass.template step<true>()) ++done;
  motion.x += lead * 0.5 * duration_s * mass.speeds;
  motion.w = mass.w;
  motion.bristle = mass.z;
  if (done < parts)
    move_on_bristles_in_short_steps(bristles, mobility, lead, motion, effort, duration_s, parts - done, contact);
}

/// Lets the deflection follow a known speed: the bristle's equation, corrected towards the deflection that carries
/// `contact_effort` (the motor's effort minus that for acceleration) as fast as the mass on the bristles settles.
template <typename Contact>
void follow_bristles(const Bristles& bristles, double inertia, DriveMotion& motion, double w, double contact_effort,
                     double duration_s, const Contact& contact) {
  const int side = w >= 0.0 ? 0 : 1;
  const double speed = std::abs(w), sign = w >= 0.0 ? 1.0 : -1.0;
  const double g = contact.dry(side, speed).effort;
  if (g <= 0.0) return;
  const double settled = g / bristles.stiffness;
  const double left = decay(speed / settled * duration_s);  // of its error before this step
  if (w != 0.0) motion.bristle = sign * settled + (motion.bristle - sign * settled) * left;
  const double viscous = sign * contact.viscous(side, speed).effort;
  const double carried = (contact_effort - viscous - bristles.damping * w) / bristles.stiffness;
  // The error at rest fades with the travel. The smaller the error, the smaller the gain must be against noise of the
  // acceleration; as in a Kalman filter, the gain is proportional to the squared error.
  if (w == 0.0) motion.bristle_doubt = 1.0;
  motion.bristle_doubt *= left;
  const double rate = motion.bristle_doubt * motion.bristle_doubt * std::sqrt(bristles.stiffness / inertia);
  motion.bristle += (carried - motion.bristle) * (1.0 - decay(rate * duration_s));
  motion.bristle = std::clamp(motion.bristle, -settled, settled);
}

}  // namespace sim
