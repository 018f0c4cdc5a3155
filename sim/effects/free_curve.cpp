// A curve without a formula.
#include <algorithm>

#include "sim/curve.hpp"
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install_free_curve(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  const Curve curve(entry);
  if (entry.over == "speed") {
    drive.sliding_friction.push_back([curve](int side, double speed) {
      const double sign = side == 0 ? 1.0 : -1.0;
      return FrictionPoint{sign * curve(sign * speed), curve.slope(sign * speed)};
    });
  } else if (entry.over == "friction_along_position") {
    drive.further_level.push_back([curve](double, double x) { return curve(x); });
  } else if (entry.over == "friction_over_time") {
    drive.further_level.push_back([curve](double t_s, double) { return curve(t_s); });
  } else if (entry.over == "travel_since_reversal") {
    drive.friction_after_reversal.push_back(curve);
  } else if (entry.over == "current") {
    drive.effort_limit.push_back([curve](double effort, double) { return effort - curve(effort); });
  } else {
    const bool by_time = entry.over == "time";
    if (curve.period() > 0.0) drive.finest_period = std::min(drive.finest_period, curve.period());
    drive.load_effort.push_back([curve, by_time](double t_s, double x) { return -curve(by_time ? t_s : x); });
  }
}

}  // namespace

extern const EffectInfo free_curve;
const EffectInfo free_curve{
    .kind = "free_curve",
    .title = "A curve without a formula",
    .equation =
        "T_motor = ... + f(q), f linear between its knots and constant beyond them; q: speed, position, "
        "friction_along_position, travel_since_reversal, time, friction_over_time, current (the motor's torque) or "
        "phase (the position within a period, which goes from the first knot to the last). Over speed, over "
        "travel_since_reversal and over friction_along_position or friction_over_time, f is friction",
    .stage = Stage::load,
    .curve = true,
    .parameters = {{.id = "knot",
                    .rotary_key = "knots",
                    .linear_key = "knots",
                    .doc = "q, rising: rad/s or m/s, mm or m, s, Nm or N",
                    .lower = -1e7,
                    .upper = 1e7,
                    .starts = {0.0}},
                   {.id = "value",
                    .rotary_key = "values_Nm",
                    .linear_key = "values_N",
                    .doc = "f at the knots: torque or force beyond the other effects",
                    .lower = -1e6,
                    .upper = 1e6,
                    .scale = Scale::coulomb,
                    .starts = {0.0}}},
    .shows = "Residual torque depends on one coordinate, and no effect of the catalogue has that shape",
    .confused_with = {"nonlinear_viscous", "cogging", "thermal_friction_drift", "presliding"},
    .separate_by =
        "It gives no cause: look at its shape, then vary only that coordinate, slowly and over its whole range. A "
        "curve over current can represent dac_dead_zone and current_saturation. No curve represents effects of two "
        "coordinates (torque_ripple: phase and torque; thermal_friction_drift: time and direction), of acceleration "
        "(input_delay, current_loop_lag, compliance, backlash), of rest and breakaway (presliding, friction_lag, "
        "dwell_stiction), or of a sensor (tach_gain, tach_offset, tach_lag, tach_ripple, encoder_cyclic_error)",
    .origin = "Anything that the catalogue does not contain, or contains with another shape",
    .remedy = "Use the curve as a feed-forward, over speed and position",
    .install = install_free_curve,
};

}  // namespace sim::effects
