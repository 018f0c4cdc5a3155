// Friction that drifts as the drive warms up.
#include "sim/drive.hpp"
#include "sim/effect.hpp"
#include "sim/warming.hpp"

namespace sim::effects {

namespace {

void install_thermal_friction_drift(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  const double b = entry.at("viscous_change"), c = entry.at("coulomb_change");
  const Warming warming(entry);
  drive.level_factor.push_back([=](double t_s, double) { return 1.0 + c * warming(t_s); });
  drive.viscous_factor.push_back([=](double t_s) { return 1.0 + b * warming(t_s); });
}

}  // namespace

extern const EffectInfo thermal_friction_drift;
const EffectInfo thermal_friction_drift{
    .kind = "thermal_friction_drift",
    .title = "Friction that drifts as the drive warms up",
    .equation =
        "B(t) = B (1 + b (1 - exp(-(t - t0)/tau))), T_coul(t) = T_coul (1 + c (1 - exp(-(t - t0)/tau))); t0: cold "
        "start",
    .stage = Stage::friction,
    .parameters =
        {{.id = "viscous_change",
          .rotary_key = "viscous_change",
          .linear_key = "viscous_change",
          .doc = "b: change of the viscous coefficient when warm, relative",
          .lower = -0.95,
          .upper = 3.0,
          .starts = {-0.2}},
         {.id = "coulomb_change",
          .rotary_key = "coulomb_change",
          .linear_key = "coulomb_change",
          .doc = "c: change of Coulomb and static friction when warm, relative",
          .lower = -0.95,
          .upper = 3.0,
          .starts = {-0.05}},
         {.id = "time_constant",
          .rotary_key = "time_constant_s",
          .linear_key = "time_constant_s",
          .doc = "time constant of warm-up, tau",
          .lower = 0.5,
          .upper = 1e5,
          .scale = Scale::duration,
          .starts = {0.3, 1.0}},
         cold_start_parameter(
             "t0: time at which B and T_coul have the model's values, on the clock of the records; default 0")},
    .shows =
        "Residual torque changes with the time since the start and has the sign of the motion. It grows with speed if "
        "viscous friction drifts",
    .along = {"time", "temperature"},
    .confused_with = {"position_dependent_friction", "nonlinear_viscous", "dwell_stiction", "external_torque"},
    .separate_by =
        "Repeat one cycle for an hour, stop, repeat; log the temperature of the nut. Change the order of the motions "
        "to separate time from position and speed",
    .origin =
        "Lubricant warming up in nut, bearings and guideways: viscous friction falls by 30 to 60 % in 10 to 40 min "
        "(textbook)",
    .remedy = "Warm-up cycle before precision work; less preload; a temperature-dependent feed-forward",
    .install = install_thermal_friction_drift,
};

}  // namespace sim::effects
