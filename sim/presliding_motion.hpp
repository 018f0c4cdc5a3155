// Motion of one mass on elastic bristles (LuGre: Canudas de Wit et al., IEEE TAC 40(3), 1995):
//   J dw/dt = T - sigma0 z - sigma1 dz/dt - B w,   dz/dt = w - sigma0 |w| z / g(w),
// where g(w) is the curve of eq. (19) without its viscous term.
#pragma once

#include <algorithm>
#include <cmath>

#include "sim/friction.hpp"

namespace sim {

/// Longest step: half a radian of the mass swinging on its bristles, at most 1 ms: the contacts of machines swing at
/// some 200 to 300 rad/s, which 0.3 radian a step shift by 0.4 %. The fast decay of z at speed is left to the implicit
/// scheme. Not below 20 us: contacts so stiff deflect by nanometres.
inline double presliding_step_s(const Bristles& bristles, double inertia) {
  return std::clamp(0.5 * std::sqrt(inertia / bristles.stiffness), 20e-6, 1e-3);
}

/// Linearly implicit scheme of order 2 (ROS2, gamma = 1 - 1/sqrt 2, L-stable), `parts` steps of `duration_s` each: two
/// stages, each one 2-by-2 solution.
template <typename Contact>
[[gnu::noinline]] void move_on_bristles(const Bristles& bristles, double mobility, double lead, DriveMotion& motion,
                                        double effort, double duration_s, int parts, Contact& contact) {
  const double stiffness = bristles.stiffness, damping = bristles.damping;
  struct Rates {
    double w, z;
  };
  struct Curve {
    double g, per_g, g_slope, further, further_slope;
  };
  const auto curve_at = [&](double w) {
    const int side = w >= 0.0 ? 0 : 1;
    const FrictionPoint dry = contact.dry(side, std::abs(w)), viscous = contact.viscous(side, std::abs(w));
    const double g = std::max(dry.effort, 1e-9);
    return Curve{g, 1.0 / g, dry.slope, viscous.effort, viscous.slope};
  };
  // Within so small a change of its level a curve is as good as straight.
  const auto straight_on = [&](const Curve& curve, double w0, double w1) {
    constexpr double kStraight = 0.01;
    const double faster = std::abs(w1) - std::abs(w0), change = curve.g_slope * faster * curve.per_g;
    if (!(w0 * w1 > 0.0 && std::abs(change) < kStraight)) return curve_at(w1);
    const double per_change = 1.0 - change + change * change;
    return Curve{curve.g * (1.0 + change), curve.per_g * per_change, curve.g_slope,
                 curve.further + curve.further_slope * faster, curve.further_slope};
  };
  const auto rates = [&](double w, double z, const Curve& curve) {
    const double z_rate = w - stiffness * std::abs(w) * z * curve.per_g;
    const double viscous = w >= 0.0 ? curve.further : -curve.further;
    return Rates{(effort - stiffness * z - damping * z_rate - viscous) * mobility, z_rate};
  };
  const double most_per_g = 1.5 / stiffness;
  const double h = duration_s, gamma_h = (1.0 - std::sqrt(0.5)) * h;
  double x = motion.x, w0 = motion.w, z0 = motion.bristle;
  for (int part = 0; part < parts; ++part) {
    const Curve curve = curve_at(w0);
    const Rates now = rates(w0, z0, curve);

    // Jacobian at the start of the step.
    const double sign = w0 >= 0.0 ? 1.0 : -1.0, speed = std::abs(w0);
    const double zz = -stiffness * speed * curve.per_g;
    const double zw = 1.0 - stiffness * z0 * sign * curve.per_g * (1.0 - speed * curve.g_slope * curve.per_g);
    const double ww = (-damping * zw - curve.further_slope) * mobility;
    const double wz = (-stiffness - damping * zz) * mobility;
    const double a = 1.0 - gamma_h * ww, b = -gamma_h * wz, c = -gamma_h * zw, d = 1.0 - gamma_h * zz;
    const double per_determinant = 1.0 / (a * d - b * c);
    const auto solve = [&](const Rates& right) {
      return Rates{(d * right.w - b * right.z) * per_determinant, (a * right.z - c * right.w) * per_determinant};
    };
    const Rates k1 = solve(now);
    const double w1 = w0 + h * k1.w, z1 = z0 + h * k1.z;
    const Curve then = straight_on(curve, w0, w1);
    const Rates at_end = rates(w1, z1, then);
    const Rates k2 = solve({at_end.w - 2.0 * k1.w, at_end.z - 2.0 * k1.z});
    const double w2 = w0 + h * (1.5 * k1.w + 0.5 * k2.w);
    z0 += h * (1.5 * k1.z + 0.5 * k2.z);
    // A bristle gives way before it is bent half as far again as steady sliding bends it.
    const double most = most_per_g * std::max(curve.g, then.g);
    z0 = std::clamp(z0, -most, most);
    x += lead * 0.5 * h * (w0 + w2);
    w0 = w2;
  }
  motion.x = x;
  motion.w = w0;
  motion.bristle = z0;
}

/// Lets the deflection follow a speed that is known: the bristle's equation, drawn towards the deflection that carries
/// `contact_effort` (what the motor gives beyond acceleration) as fast as the mass on the bristles itself settles.
inline void follow_bristles(const Bristles& bristles, const FrictionSide& side, double inertia, DriveMotion& motion,
                            double w, double contact_effort, double duration_s) {
  const double g = stribeck_curve(side, side.breakaway, std::abs(w)).effort;
  if (g <= 0.0) return;
  const double settled = g / bristles.stiffness;
  if (w != 0.0) {
    const double end = w > 0.0 ? settled : -settled;
    motion.bristle = end + (motion.bristle - end) * decay(std::abs(w) / settled * duration_s);
  }
  const double carried = (contact_effort - side.viscous * w - bristles.damping * w) / bristles.stiffness;
  const double rate = std::sqrt(bristles.stiffness / inertia);
  // At speed the bristle's own equation settles faster than that, and knows better than a noisy acceleration.
  if (std::abs(w) / settled < rate) motion.bristle += (carried - motion.bristle) * (1.0 - decay(rate * duration_s));
  motion.bristle = std::clamp(motion.bristle, -settled, settled);
}

}  // namespace sim
