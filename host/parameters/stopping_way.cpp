#include "host/parameters/stopping_way.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/identify/friction_law.hpp"
#include "host/identify/linear_axis.hpp"

namespace host {

namespace {

/// The smallest friction of the curve up to the speed, without its viscous part.
double least_friction(const sim::DriveDescription& model, double top_speed) {
  const FrictionLaw law = friction_law(model);
  constexpr int kPlaces = 100;
  double least = std::min(law.positive.coulomb, law.negative.coulomb);
  for (int place = 1; place <= kPlaces; ++place) {
    const double speed = top_speed * place / kPlaces;
    least = std::min({least, law.positive.at(speed), law.negative.at(speed)});
  }
  return std::max(least, 0.0);
}

/// Stopping distance and time under a constant torque or force against the motion.
StoppingWay coast(const StoppingFigures& axis, double speed, double effort) {
  if (speed == 0.0) return {};
  if (!(effort > 0.0)) return {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  const double deceleration = axis.lead * effort / axis.inertia;
  return {speed * speed / (2.0 * deceleration), speed / deceleration};
}

}  // namespace

StoppingFigures stopping_figures(const sim::DriveDescription& model, double top_speed, double deceleration,
                                 double jerk) {
  StoppingFigures axis;
  axis.inertia = rigid_axis(model).inertia;
  axis.friction = least_friction(model, top_speed / model.data.lead);
  for (const sim::EffectEntry& effect : model.effects)
    if (effect.kind == "constant_torque") axis.weight += effect.at("torque");
  axis.weight = std::abs(axis.weight);
  axis.lead = model.data.lead;
  axis.deceleration = deceleration;
  axis.jerk = jerk;
  return axis;
}

StoppingWay ramp_way(const StoppingFigures& axis, double speed, double acceleration) {
  return broken_ramp_way(axis, speed, speed, 0.0, acceleration);
}

StoppingWay drop_way(const StoppingFigures& axis, double speed) {
  const StoppingWay free = coast(axis, speed, axis.friction - axis.weight);
  if (!axis.brake) return axis.weight > axis.friction ? coast(axis, 1.0, 0.0) : free;
  const double t = axis.brake_time_s;
  const double gained = axis.lead * std::max(axis.weight - axis.friction, 0.0) / axis.inertia * t;
  const StoppingWay held = coast(axis, speed + gained, axis.friction + axis.brake_effort - axis.weight);
  const StoppingWay braked{(speed + gained / 2.0) * t + held.travel, t + held.time_s};
  return axis.friction > axis.weight && free.travel < braked.travel ? free : braked;
}

StoppingWay broken_ramp_way(const StoppingFigures& axis, double speed, double top_speed, double drop_speed,
                            double acceleration) {
  const double before_s = acceleration / axis.jerk;
  const double fastest = std::max(speed + acceleration * before_s / 2.0, top_speed);
  const double jerk_s = axis.deceleration / axis.jerk;
  const StoppingWay drop = drop_speed > 0.0 ? drop_way(axis, drop_speed) : StoppingWay{};
  return {(speed + acceleration * before_s / 3.0) * before_s +
              (fastest * fastest - drop_speed * drop_speed) / (2.0 * axis.deceleration) + fastest * jerk_s / 2.0 +
              drop.travel,
          before_s + (fastest - drop_speed) / axis.deceleration + jerk_s + drop.time_s};
}

}  // namespace host
