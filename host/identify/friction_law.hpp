// The friction curve (19) of a model, from each form that the model file allows.
#pragma once

#include "sim/drive_description.hpp"

namespace host {

/// One direction of eq. (19), magnitudes: static*exp(-v/omega1) + coulomb*(1 - exp(-v/omega2)), v = |speed|.
struct FrictionSideLaw {
  double static_level = 0.0;  ///< Nm or N, >= 0; equal to coulomb if the model has no Stribeck effect
  double coulomb = 0.0;       ///< Nm or N, >= 0
  double omega1 = 0.0;        ///< rad/s or m/s, >= 0; for 0 the exponential is 0
  double omega2 = 0.0;

  /// Friction at v > 0 without the viscous part.
  double at(double v) const;
};

struct FrictionLaw {
  FrictionSideLaw positive, negative;
  double viscous = 0.0;  ///< B

  /// Friction torque or force with its sign at a speed (rad/s or m/s); 0 at standstill.
  double effort(double speed) const;
};

/// From the effects `viscous`, `coulomb`, `stribeck` (per direction, or one value for both).
FrictionLaw friction_law(const sim::DriveDescription& model);

/// Whether the model has one Coulomb level for both directions. A fit keeps that form.
bool is_symmetric(const sim::DriveDescription& model);

}  // namespace host
