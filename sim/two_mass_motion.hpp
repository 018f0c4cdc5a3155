// Motor and table as two masses on a spring, with or without a gap:
//   J1 dw1/dt = T - s,   J2 dw2/dt = s - friction(w2),   s = k d + c dd/dt,
// d = the spring's deflection beyond the gap (Nordin, Gutman, Automatica 38, 2002: the contact only pushes).
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/friction.hpp"

namespace sim {

/// A quarter of a radian of the fastest mode a step: the semi-implicit scheme then shifts a resonance by 0.3 %.
inline double two_mass_step_s(const SecondMass& mass) {
  return 0.25 / (2.0 * std::numbers::pi * std::max(mass.resonance_Hz, 1.0));
}

/// The coupling of the two masses, per rad of deflection (or m).
struct Coupling {
  double motor_inertia, load_inertia, stiffness, damping, half_gap;

  Coupling(const SecondMass& mass, double inertia, double lead)
      : motor_inertia(inertia * (1.0 - mass.load_fraction)),
        load_inertia(inertia * mass.load_fraction),
        half_gap(0.5 * mass.gap / lead) {
    const double reduced = motor_inertia * load_inertia / inertia;
    const double omega = 2.0 * std::numbers::pi * mass.resonance_Hz;
    stiffness = reduced * omega * omega;
    damping = 2.0 * mass.damping_ratio * reduced * omega;
  }

  double effort(double twist, double twist_rate) const {
    const double deflection = twist > half_gap ? twist - half_gap : (twist < -half_gap ? twist + half_gap : 0.0);
    if (deflection == 0.0) return half_gap > 0.0 ? 0.0 : damping * twist_rate;
    const double push = stiffness * deflection + damping * twist_rate;
    if (half_gap <= 0.0) return push;
    return deflection > 0.0 ? std::max(push, 0.0) : std::min(push, 0.0);
  }
};

template <typename Contact>
inline void move_two_masses(const SecondMass& second, double inertia, double lead, DriveState& state, double effort,
                            double duration_s, Contact& contact) {
  const Coupling coupling(second, inertia, lead);
  // Positions half a step ahead, speeds over the whole step: symplectic, order 2 for the spring.
  const double half_s = 0.5 * duration_s;
  const double motor_middle = state.x + half_s * lead * state.w;
  const double load_middle = state.load_x + half_s * lead * state.load_w;
  const double spring = coupling.effort((motor_middle - load_middle) / lead, state.w - state.load_w);
  SlidingMass load{load_middle, state.load_w, 1.0 / coupling.load_inertia, 0.0};
  slide(load, spring, duration_s, contact);
  state.w += duration_s * (effort - spring) / coupling.motor_inertia;
  state.load_w = load.w;
  state.x = motor_middle + half_s * lead * state.w;
  state.load_x = load_middle + half_s * lead * state.load_w;
}

}  // namespace sim
