// Motion of one mass on elastic bristles (LuGre: Canudas de Wit et al., IEEE TAC 40(3), 1995):
//   J dw/dt = T - sigma0 z - sigma1 dz/dt - B w,   dz/dt = w - sigma0 |w| z / g(w),
// where g(w) is the curve of eq. (19) without its viscous term.
#pragma once

#include <algorithm>
#include <cmath>

#include "sim/friction.hpp"

namespace sim {

/// Longest step: half a radian of the mass swinging on its bristles, at most 0.5 ms: the contacts of machines swing at
/// some 200 to 300 rad/s, followed within 1 % a period. The fast decay of z at speed is left to the implicit scheme.
/// Not below 20 us: contacts so stiff deflect by nanometres.
inline double presliding_step_s(const Bristles& bristles, double inertia) {
  return std::clamp(0.5 * std::sqrt(inertia / bristles.stiffness), 20e-6, 0.5e-3);
}

/// Linearly implicit scheme of order 2 (ROS2, gamma = 1 - 1/sqrt 2, L-stable): two stages, each one 2-by-2 solution.
template <typename Contact>
inline void move_on_bristles(const Bristles& bristles, double inertia, double lead, DriveState& state, double effort,
                             double duration_s, Contact& contact) {
  struct Rates {
    double w, z;
  };
  struct Curve {
    double g, g_slope, further, further_slope;
  };
  const auto curve_at = [&](double w) {
    // sliding() gives curve + viscous; the bristles carry the curve alone, so the viscous part is taken out again.
    const FrictionPoint all = contact.sliding(w >= 0.0 ? 0 : 1, std::abs(w));
    const FrictionPoint viscous = contact.viscous(w >= 0.0 ? 0 : 1, std::abs(w));
    return Curve{std::max(all.effort - viscous.effort, 1e-9), all.slope - viscous.slope, viscous.effort, viscous.slope};
  };
  const auto rates = [&](double w, double z, const Curve& curve) {
    const double z_rate = w - bristles.stiffness * std::abs(w) * z / curve.g;
    const double viscous = w >= 0.0 ? curve.further : -curve.further;
    return Rates{(effort - bristles.stiffness * z - bristles.damping * z_rate - viscous) / inertia, z_rate};
  };
  const double gamma = 1.0 - std::sqrt(0.5);
  const double h = duration_s;
  const Curve curve = curve_at(state.w);
  const Rates now = rates(state.w, state.bristle, curve);

  // Jacobian at the start of the step.
  const double sign = state.w >= 0.0 ? 1.0 : -1.0;
  const double pull = bristles.stiffness * std::abs(state.w) / curve.g;
  const double zw =
      1.0 - bristles.stiffness * state.bristle * sign / curve.g * (1.0 - std::abs(state.w) * curve.g_slope / curve.g);
  const double zz = -pull;
  const double ww = (-bristles.damping * zw - curve.further_slope) / inertia;
  const double wz = (-bristles.stiffness - bristles.damping * zz) / inertia;
  const double a = 1.0 - gamma * h * ww, b = -gamma * h * wz, c = -gamma * h * zw, d = 1.0 - gamma * h * zz;
  const double determinant = a * d - b * c;
  const auto solve = [&](const Rates& right) {
    return Rates{(d * right.w - b * right.z) / determinant, (a * right.z - c * right.w) / determinant};
  };
  const Rates k1 = solve(now);
  const double w1 = state.w + h * k1.w;
  const double z1 = state.bristle + h * k1.z;
  Rates second = rates(w1, z1, curve_at(w1));
  second.w -= 2.0 * k1.w;
  second.z -= 2.0 * k1.z;
  const Rates k2 = solve(second);
  const double w_end = state.w + h * (1.5 * k1.w + 0.5 * k2.w);
  state.bristle += h * (1.5 * k1.z + 0.5 * k2.z);
  const double g_end = curve_at(w_end).g;
  const double most = g_end / bristles.stiffness * 1.5;
  state.bristle = std::clamp(state.bristle, -most, most);
  state.x += lead * 0.5 * h * (state.w + w_end);
  state.w = w_end;
}

/// Lets the deflection follow a speed that is known: the bristle's equation, drawn towards the deflection that carries
/// `contact_effort` (what the motor gives beyond acceleration) as fast as the mass on the bristles itself settles.
inline void follow_bristles(const Bristles& bristles, const FrictionSide& side, double inertia, DriveState& state,
                            double w, double contact_effort, double duration_s) {
  const double g = stribeck_curve(side, side.breakaway, std::abs(w)).effort;
  if (g <= 0.0) return;
  const double settled = g / bristles.stiffness;
  if (w != 0.0) {
    const double end = w > 0.0 ? settled : -settled;
    state.bristle = end + (state.bristle - end) * std::exp(-std::abs(w) / settled * duration_s);
  }
  const double carried = (contact_effort - side.viscous * w - bristles.damping * w) / bristles.stiffness;
  const double rate = std::sqrt(bristles.stiffness / inertia);
  // At speed the bristle's own equation settles faster than that, and knows better than a noisy acceleration.
  if (std::abs(w) / settled < rate) state.bristle += (carried - state.bristle) * -std::expm1(-rate * duration_s);
  state.bristle = std::clamp(state.bristle, -settled, settled);
}

}  // namespace sim
