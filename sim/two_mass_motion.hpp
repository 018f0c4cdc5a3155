// Motor and table as two masses on a spring, with or without a gap:
//   J1 dw1/dt = T - s - (1 - p) dry(w1) - (1 - q) viscous(w1),   J2 dw2/dt = s - p dry(w2) - q viscous(w2),
//   s = k d + c dd/dt,   d = the spring's deflection beyond the gap.
#pragma once

#include <algorithm>
#include <numbers>

#include "sim/friction.hpp"

namespace sim {

/// 0.27 radian of the fastest mode a step: the semi-implicit scheme then shifts a resonance by 0.3 %.
inline double two_mass_step_s(const SecondMass& mass) {
  return 0.27 / (2.0 * std::numbers::pi * std::max(mass.resonance_Hz, 1.0));
}

/// A part of a contact's dry friction, and a part of its viscous friction. Of the two parts, the one with more of the
/// dry friction tells the contact of its stops and starts: a mass without friction only swings.
template <typename Contact>
struct PartOfContact {
  Contact& whole;
  double dry, viscous;
  bool tells;

  FrictionPoint sliding(int side, double speed) const {
    if (dry == viscous) {
      const FrictionPoint all = whole.sliding(side, speed);
      return {dry * all.effort, dry * all.slope};
    }
    const FrictionPoint rubbing = whole.dry(side, speed), fluid = whole.viscous(side, speed);
    return never_driving({dry * rubbing.effort + viscous * fluid.effort, dry * rubbing.slope + viscous * fluid.slope});
  }
  double breakaway(int side) const { return dry * whole.breakaway(side); }
  void broke_away() const {
    if (tells) whole.broke_away();
  }
  void came_to_rest() const {
    if (tells) whole.came_to_rest();
  }
  void rested(double duration_s) const {
    if (tells) whole.rested(duration_s);
  }
};

/// A mass without friction.
struct FreeMass {
  double w, kick;

  double after(double effort) const { return w + kick * effort; }
  bool gets_to(double /*end*/) const { return true; }
};

/// A mass that slides in one direction, with friction linearised once.
struct GlidingMass {
  double w;
  LinearisedContact contact;

  double after(double effort) const { return contact.after(w, effort); }
  bool gets_to(double end) const { return contact.holds_for(end); }
};

/// A mass with its stops and starts.
template <typename Contact>
struct RubbingMass {
  double w, mobility, duration_s;
  Contact contact;

  double after(double effort) {
    SlidingMass mass{0.0, w, mobility, 0.0};
    slide(mass, effort, duration_s, contact);
    return mass.w;
  }
  bool gets_to(double /*end*/) const { return true; }
};

/// Moves both under a constant torque or force for `parts` steps of `duration_s` each; ends before a step that one of
/// them cannot complete. Returns the number of completed steps.
template <typename Motor, typename Load>
[[gnu::always_inline]] inline int move_coupled(const Coupling& coupling, double lead, DriveMotion& motion,
                                               double effort, double duration_s, int parts, Motor motor, Load load) {
  // The twist is advanced by half a step, the speeds by a whole step: symplectic, order 2 for the spring.
  const double half_s = 0.5 * duration_s;
  double twist = (motion.x - motion.load_x) * coupling.per_lead;
  double motor_speeds = 0.0, load_speeds = 0.0;
  int done = 0;
  for (; done < parts; ++done) {
    const double twist_rate = motor.w - load.w, ahead = twist + half_s * twist_rate;
    const double spring = coupling.effort(ahead, twist_rate);
    const double load_w = load.after(spring), motor_w = motor.after(effort - spring);
    if (!load.gets_to(load_w) || !motor.gets_to(motor_w)) break;
    twist = ahead + half_s * (motor_w - load_w);
    motor_speeds += motor.w + motor_w;
    load_speeds += load.w + load_w;
    load.w = load_w;
    motor.w = motor_w;
  }
  motion.x += lead * half_s * motor_speeds;
  motion.load_x += lead * half_s * load_speeds;
  motion.w = motor.w;
  motion.load_w = load.w;
  return done;
}

/// The same including all stops and starts, with the contact's friction on the sides on which it acts.
template <typename Contact>
[[gnu::noinline]] void move_coupled_through_stops(const Coupling& coupling, double lead, DriveMotion& motion,
                                                  double effort, double duration_s, int parts, Contact& contact) {
  using Part = PartOfContact<Contact>;
  const double dry = coupling.load_friction, viscous = coupling.load_viscous;
  const bool more_on_load = dry > 0.5;
  const RubbingMass<Part> load{
      motion.load_w, coupling.load_mobility, duration_s, {contact, dry, viscous, more_on_load}};
  if (!coupling.all_on_load()) {
    const RubbingMass<Part> motor{
        motion.w, coupling.motor_mobility, duration_s, {contact, 1.0 - dry, 1.0 - viscous, !more_on_load}};
    move_coupled(coupling, lead, motion, effort, duration_s, parts, motor, load);
  } else {
    const FreeMass motor{motion.w, duration_s * coupling.motor_mobility};
    move_coupled(coupling, lead, motion, effort, duration_s, parts, motor, load);
  }
}

template <typename Contact>
[[gnu::always_inline]] inline void move_two_masses(const Coupling& coupling, double lead, DriveMotion& motion,
                                                   double effort, double duration_s, int parts, Contact& contact) {
  int done = 0;
  if (coupling.all_on_load() && motion.load_w != 0.0) {
    const GlidingMass load{motion.load_w, {motion.load_w, coupling.load_mobility, duration_s, contact}};
    const FreeMass motor{motion.w, duration_s * coupling.motor_mobility};
    done = move_coupled(coupling, lead, motion, effort, duration_s, parts, motor, load);
  } else if (motion.load_w != 0.0 && motion.w != 0.0) {
    using Part = PartOfContact<Contact>;
    const double dry = coupling.load_friction, viscous = coupling.load_viscous;
    const Part on_load{contact, dry, viscous, false}, on_motor{contact, 1.0 - dry, 1.0 - viscous, false};
    const GlidingMass load{motion.load_w, {motion.load_w, coupling.load_mobility, duration_s, on_load}};
    const GlidingMass motor{motion.w, {motion.w, coupling.motor_mobility, duration_s, on_motor}};
    done = move_coupled(coupling, lead, motion, effort, duration_s, parts, motor, load);
  }
  if (done < parts) move_coupled_through_stops(coupling, lead, motion, effort, duration_s, parts - done, contact);
}

}  // namespace sim
