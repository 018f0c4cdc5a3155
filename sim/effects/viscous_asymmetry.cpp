// Viscous friction that differs by direction.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install_viscous_asymmetry(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  const double asymmetry = entry.at("asymmetry");
  drive.direction_factor[0].viscous *= 1.0 + asymmetry;
  drive.direction_factor[1].viscous *= 1.0 - asymmetry;
}

}  // namespace

extern const EffectInfo viscous_asymmetry;
const EffectInfo viscous_asymmetry{
    .kind = "viscous_asymmetry",
    .title = "Viscous friction that differs by direction",
    .equation = "B+ = (1 + a) B, B- = (1 - a) B; +: forward, -: backward",
    .stage = Stage::friction,
    .parameters = {{.id = "asymmetry",
                    .rotary_key = "asymmetry",
                    .linear_key = "asymmetry",
                    .doc = "a: half the difference of the coefficients over their mean",
                    .lower = -0.95,
                    .upper = 0.95,
                    .starts = {0.1, -0.1}}},
    .shows = "The mean of forward and backward residual torque grows with speed and is zero at rest",
    .along = {"speed"},
    .confused_with = {"coulomb_asymmetry", "constant_torque", "dac_offset", "tach_offset", "nonlinear_viscous"},
    .separate_by =
        "Three or more constant speeds in each direction: an offset or unequal Coulomb levels are constant, this "
        "effect is proportional to speed",
    .origin =
        "Oil pumped in one direction by screw or seals; amplifier or sensor gain that differs by sign. 18 % was "
        "measured on a public linear axis, where a fit without this effect gave an offset",
    .remedy = "Check seals, screw cover and amplifier balance; compensate by direction",
    .install = install_viscous_asymmetry,
};

}  // namespace sim::effects
