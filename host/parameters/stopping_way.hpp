// Distance and duration of a stop, by formulas from the drive's parameters (README, "The board").
#pragma once

#include "sim/drive_description.hpp"

namespace host {

/// Properties of an axis, in mm and rad, or in m for a linear drive.
struct StoppingFigures {
  double inertia = 0.0;       ///< J, kg m^2 or kg, > 0
  double friction = 0.0;      ///< T, smallest Coulomb friction of both directions up to the top speed, Nm or N, >= 0
  double weight = 0.0;        ///< W, magnitude of the constant load, Nm or N, >= 0
  double lead = 1.0;          ///< r, travel per radian, > 0
  double deceleration = 0.0;  ///< a, of the ramp, > 0
  double jerk = 0.0;          ///< j, > 0
  bool brake = false;         ///< a brake is fitted
  double brake_time_s = 0.0;  ///< t, from its current off until it holds
  double brake_effort = 0.0;  ///< torque or force of the brake, Nm or N; 0 if unknown: the brake then only holds
};

/// Friction, weight and inertia by the model. Throws Failure(bad_input) for a model without inertia.
StoppingFigures stopping_figures(const sim::DriveDescription& model, double top_speed, double deceleration,
                                 double jerk);

struct StoppingWay {
  double travel = 0.0;  ///< infinite if nothing stops the axis
  double time_s = 0.0;
};

/// Stop along the ramp, v^2 / (2 a) + v a / (2 j), from the speed v >= 0. `acceleration` >= 0: acceleration of the
/// reference at the beginning of the stop; the speed first grows by acceleration^2 / (2 j).
StoppingWay ramp_way(const StoppingFigures& axis, double speed, double acceleration = 0.0);

/// Stop with the enable off, the weight along the motion: v^2 J / (2 r (T - W)). With a brake: v t + r (W - T) t^2 / (2
/// J) until it holds, if W > T, then as above with the brake's torque or force added to the friction.
StoppingWay drop_way(const StoppingFigures& axis, double speed);

/// Stop along the ramp from the highest speed, `top_speed`, to `drop_speed`, at which the enable drops (0: it stays
/// on). A second fault may raise `top_speed` above the speed that follows from the acceleration.
StoppingWay broken_ramp_way(const StoppingFigures& axis, double speed, double top_speed, double drop_speed,
                            double acceleration);

}  // namespace host
