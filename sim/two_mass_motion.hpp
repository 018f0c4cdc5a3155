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

/// A mass without friction.
class FreeMass {
 public:
  FreeMass(double w, double kick) : w_(w), kick_(kick) {}
  double w() const { return w_; }
  void step(double effort) { w_ += kick_ * effort; }

 private:
  double w_, kick_;
};

/// The speed of one of the masses through the short steps of a sample.
template <typename Contact>
class RubbingMass {
 public:
  RubbingMass(double w, double mobility, double duration_s, Contact& contact)
      : w_(w), mobility_(mobility), duration_s_(duration_s), contact_(contact), sliding_(linearised()) {}

  double w() const { return w_; }
  void step(double effort) {
    if (sliding_.moves(w_, effort)) return;
    SlidingMass mass{0.0, w_, mobility_, 0.0};
    slide(mass, effort, duration_s_, contact_);
    w_ = mass.w;
    if (w_ != 0.0) sliding_ = linearised();
  }

 private:
  LinearisedContact linearised() const { return {w_, mobility_, duration_s_, contact_}; }

  double w_, mobility_, duration_s_;
  Contact& contact_;
  LinearisedContact sliding_;
};

/// Moves both for `parts` steps of `duration_s` each under a constant effort.
template <typename Contact>
inline void move_two_masses(const Coupling& coupling, double lead, DriveMotion& motion, double effort,
                            double duration_s, int parts, Contact& contact) {
  // Positions half a step ahead, speeds over the whole step: symplectic, order 2 for the spring.
  const double half_way = 0.5 * duration_s * lead;
  double x = motion.x, load_x = motion.load_x;
  const auto go = [&](auto& motor, auto& load) {
    for (int part = 0; part < parts; ++part) {
      x += half_way * motor.w();
      load_x += half_way * load.w();
      const double spring = coupling.effort((x - load_x) * coupling.per_lead, motor.w() - load.w());
      load.step(spring);
      motor.step(effort - spring);
      x += half_way * motor.w();
      load_x += half_way * load.w();
    }
    motion.w = motor.w();
    motion.load_w = load.w();
  };
  if (coupling.load_friction < 1.0) {
    PartOfContact<Contact> on_load{contact, coupling.load_friction}, on_motor{contact, 1.0 - coupling.load_friction};
    RubbingMass motor(motion.w, coupling.motor_mobility, duration_s, on_motor);
    RubbingMass load(motion.load_w, coupling.load_mobility, duration_s, on_load);
    go(motor, load);
  } else {
    FreeMass motor(motion.w, duration_s * coupling.motor_mobility);
    RubbingMass load(motion.load_w, coupling.load_mobility, duration_s, contact);
    go(motor, load);
  }
  motion.x = x;
  motion.load_x = load_x;
}

}  // namespace sim
