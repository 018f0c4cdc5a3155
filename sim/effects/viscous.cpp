// Viscous friction.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install([[maybe_unused]] const EffectEntry& entry, [[maybe_unused]] const DataSheet& data, Drive& drive) {
  for (FrictionSide& side : drive.friction) side.viscous += entry.at("B");
}

}  // namespace

extern const EffectInfo viscous;
const EffectInfo viscous{
    .kind = "viscous",
    .title = "Viscous friction",
    .equation = "T_f = B w (eq. 1)",
    .stage = Stage::friction,
    .base = true,
    .parameters = {{.id = "B",
                    .rotary_key = "B_Nm_s_per_rad",
                    .linear_key = "B_N_s_per_m",
                    .doc = "viscous coefficient",
                    .lower = 0.0,
                    .upper = 1e6,
                    .scale = Scale::viscous,
                    .starts = {1}}},
    .shows = "residual torque proportional to speed",
    .confused_with = {"nonlinear_viscous", "viscous_asymmetry", "tach_gain", "voltage_limit"},
    .separate_by = "five constant speeds or more, both ways, at one temperature",
    .origin = "lubricant in guideways, nut and bearings; eddy currents in the motor",
    .remedy = "check grade and amount of lubricant",
    .install = install,
};

}  // namespace sim::effects
