// A curve that no formula gives.
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
        "T_motor = ... + f(q), f straight between its knots and level beyond them; q: speed, position, "
        "friction_along_position, travel_since_reversal, time, friction_over_time, current (the motor's torque) or "
        "phase (the position within a period, which goes from the first knot to the last). Over speed, since a "
        "reversal and where it is called so f is friction",
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
                    .doc = "f there: what the motion needs beyond the other effects",
                    .lower = -1e6,
                    .upper = 1e6,
                    .scale = Scale::coulomb,
                    .starts = {0.0}}},
    .shows = "Residual torque follows one coordinate, and no effect of the catalogue has that shape",
    .confused_with = {"nonlinear_viscous", "cogging", "thermal_friction_drift", "presliding"},
    .separate_by =
        "It names nothing: look at its shape, then record that coordinate alone, slowly and over its whole range. "
        "Asked for over current it carries dac_dead_zone and current_saturation. No curve carries what two coordinates "
        "make together (torque_ripple: phase and torque; thermal_friction_drift: time and direction), what goes with "
        "acceleration (input_delay, current_loop_lag, compliance, backlash: a second mass in its gap), what acts at "
        "rest and at breaking away alone (presliding, friction_lag, dwell_stiction), nor a sensor's error, which is no "
        "effort (tach_gain, tach_offset, tach_lag, tach_ripple, encoder_cyclic_error)",
    .origin = "Whatever the catalogue does not hold, or holds in another shape",
    .remedy = "The curve itself serves a feed-forward, over speed and position",
    .install = install_free_curve,
};

}  // namespace sim::effects
