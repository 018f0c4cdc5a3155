// Motor and table on a spring, with or without a gap between them (Nordin, Gutman, Automatica 38, 2002: the contact
// only pushes).
#pragma once

#include <algorithm>
#include <numbers>

namespace sim {

/// A load on a spring, with or without a gap between motor and table.
struct SecondMass {
  double load_fraction = 0.0;  ///< part of the inertia behind the spring, 0..1
  double resonance_Hz = 0.0;   ///< of both masses on the spring, free to move
  double damping_ratio = 0.0;
  double gap = 0.0;            ///< free travel, mm or m
  double load_friction = 1.0;  ///< part of the drive's dry friction that acts on the load's side, 0..1
  double load_viscous = 1.0;   ///< part of its viscous friction, 0..1
};

/// The coupling of the two masses, per rad of deflection (or m).
struct Coupling {
  double motor_mobility, load_mobility;  ///< 1/inertia
  double stiffness, damping, half_gap;
  double per_lead;
  double load_friction, load_viscous;

  Coupling(const SecondMass& mass, double inertia, double lead)
      : motor_mobility(1.0 / (inertia * (1.0 - mass.load_fraction))),
        load_mobility(1.0 / (inertia * mass.load_fraction)),
        half_gap(0.5 * mass.gap / lead),
        per_lead(1.0 / lead),
        load_friction(mass.load_friction),
        load_viscous(mass.load_viscous) {
    const double reduced = inertia * mass.load_fraction * (1.0 - mass.load_fraction);
    const double omega = 2.0 * std::numbers::pi * mass.resonance_Hz;
    stiffness = reduced * omega * omega;
    damping = 2.0 * mass.damping_ratio * reduced * omega;
  }

  bool all_on_load() const { return load_friction == 1.0 && load_viscous == 1.0; }

  double effort(double twist, double twist_rate) const {
    if (half_gap <= 0.0) return stiffness * twist + damping * twist_rate;
    if (twist > half_gap) return std::max(stiffness * (twist - half_gap) + damping * twist_rate, 0.0);
    if (twist < -half_gap) return std::min(stiffness * (twist + half_gap) + damping * twist_rate, 0.0);
    return 0.0;
  }
};

}  // namespace sim
