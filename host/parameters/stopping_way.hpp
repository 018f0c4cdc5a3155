// Distance and duration of a stop, by formula from the drive (README, "The board").
#pragma once

#include "sim/drive_description.hpp"

namespace host {

/// Figures of an axis: mm and rad, or only m for a linear drive.
struct StoppingFigures {
  double inertia = 0.0;       ///< J, kg m^2 or kg, > 0
  double friction = 0.0;      ///< T, least Coulomb friction of both directions up to the top speed, Nm or N, >= 0
  double weight = 0.0;        ///< W, magnitude of the constant load, Nm or N, >= 0
  double lead = 1.0;          ///< r, travel per radian, > 0
  double deceleration = 0.0;  ///< a, of the ramp, > 0
  double jerk = 0.0;          ///< j, > 0
  bool brake = false;         ///< one is fitted
  double brake_time_s = 0.0;  ///< t, from its current off until it holds
  double brake_effort = 0.0;  ///< of the brake, Nm or N; unknown: 0, it then only holds
};

/// Friction, weight and inertia by the model. Throws Failure(bad_input) for a model without inertia.
StoppingFigures stopping_figures(const sim::DriveDescription& model, double top_speed, double deceleration,
                                 double jerk);

struct StoppingWay {
  double travel = 0.0;  ///< infinite where nothing stops it
  double time_s = 0.0;
};

/// Along the ramp: v^2 / (2 a) + v a / (2 j), from the speed v >= 0. `acceleration` >= 0: of the reference when the
/// stop begins; the speed first grows by acceleration^2 / (2 j).
StoppingWay ramp_way(const StoppingFigures& axis, double speed, double acceleration = 0.0);

/// With the enable dropped: v^2 J / (2 r (T - W)), the weight along the motion. With a brake: v t + r (W - T) t^2 / (2
/// J) until it holds, if W > T, then as above with the brake's effort beside the friction.
StoppingWay drop_way(const StoppingFigures& axis, double speed);

/// Along the ramp from the highest speed, `top_speed`, to the speed `drop_speed`, where the enable drops; 0: it does
/// not. `top_speed` beyond what the acceleration gives: by a second fault.
StoppingWay broken_ramp_way(const StoppingFigures& axis, double speed, double top_speed, double drop_speed,
                            double acceleration);

}  // namespace host
