// Viscous friction.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install_viscous(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  for (FrictionSide& side : drive.friction) side.viscous += entry.at("B");
}

}  // namespace

extern const EffectInfo viscous;
const EffectInfo viscous{
    .kind = "viscous",
    .title = "Viscous friction",
    .equation = "T_f = B w (eq. 1); w: shaft speed",
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
    .shows = "Residual torque is proportional to speed, with opposite sign in the two directions",
    .along = {"speed"},
    .confused_with = {"nonlinear_viscous", "viscous_asymmetry", "tach_gain", "voltage_limit", "thermal_friction_drift"},
    .separate_by =
        "Five or more constant speeds in both directions at one temperature; first check the tachometer against the "
        "encoder, because a gain error of 1 % can change B by tens of per cent",
    .origin =
        "Lubricant in guideways, nut and bearings; eddy currents and iron losses in the motor. Falls by 30 to 60 % as "
        "the drive warms up (textbook)",
    .remedy = "Check grade and amount of lubricant; identify at working temperature",
    .install = install_viscous,
};

}  // namespace sim::effects
