// Motor and table as two masses on a spring, with or without a gap:
//   J1 dw1/dt = T - s - (1 - p) friction(w1),   J2 dw2/dt = s - p friction(w2),   s = k d + c dd/dt,
// d = the spring's deflection beyond the gap.
#pragma once

#include <algorithm>
#include <numbers>

#include "sim/friction.hpp"

namespace sim {

/// 0.27 radian of the fastest mode a step: the semi-implicit scheme then shifts a resonance by 0.3 %.
inline double two_mass_step_s(const SecondMass& mass) {
  return 0.27 / (2.0 * std::numbers::pi * std::max(mass.resonance_Hz, 1.0));
}

/// A part of a contact's friction.
template <typename Contact>
struct PartOfContact {
  Contact& whole;
  double part;

  FrictionPoint sliding(int side, double speed) const {
    const FrictionPoint all = whole.sliding(side, speed);
    return {part * all.effort, part * all.slope};
  }
  double breakaway(int side) const { return part * whole.breakaway(side); }
  void broke_away() const { whole.broke_away(); }
  void came_to_rest() const { whole.came_to_rest(); }
  void rested(double duration_s) const { whole.rested(duration_s); }
};

/// Moves both for `parts` steps of `duration_s` each under a constant effort.
template <typename Contact>
inline void move_two_masses(const Coupling& coupling, double lead, DriveMotion& motion, double effort,
                            double duration_s, int parts, Contact& contact) {
  // Positions half a step ahead, speeds over the whole step: symplectic, order 2 for the spring.
  const double half_way = 0.5 * duration_s * lead, motor_kick = duration_s * coupling.motor_mobility;
  double x = motion.x, w = motion.w, load_x = motion.load_x;
  SlidingMass load{0.0, motion.load_w, coupling.load_mobility, 0.0};
  const bool both_rub = coupling.load_friction < 1.0;
  PartOfContact<Contact> on_load{contact, coupling.load_friction}, on_motor{contact, 1.0 - coupling.load_friction};
  for (int part = 0; part < parts; ++part) {
    x += half_way * w;
    load_x += half_way * load.w;
    const double spring = coupling.effort((x - load_x) * coupling.per_lead, w - load.w);
    if (both_rub) {
      SlidingMass motor{0.0, w, coupling.motor_mobility, 0.0};
      slide(load, spring, duration_s, on_load);
      slide(motor, effort - spring, duration_s, on_motor);
      w = motor.w;
    } else {
      slide(load, spring, duration_s, contact);
      w += motor_kick * (effort - spring);
    }
    x += half_way * w;
    load_x += half_way * load.w;
  }
  motion.x = x;
  motion.w = w;
  motion.load_x = load_x;
  motion.load_w = load.w;
}

}  // namespace sim
