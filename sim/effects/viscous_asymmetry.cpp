// Viscous friction that differs by direction.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install([[maybe_unused]] const EffectEntry& entry, [[maybe_unused]] const DataSheet& data, Drive& drive) {
  const double asymmetry = entry.at("asymmetry");
  drive.direction_factor[0].viscous *= 1.0 + asymmetry;
  drive.direction_factor[1].viscous *= 1.0 - asymmetry;
}

}  // namespace

extern const EffectInfo viscous_asymmetry;
const EffectInfo viscous_asymmetry{
    .kind = "viscous_asymmetry",
    .title = "Viscous friction that differs by direction",
    .equation = "B+ = (1+a) B, B- = (1-a) B",
    .stage = Stage::friction,

    .parameters = {{.id = "asymmetry",
                    .rotary_key = "asymmetry",
                    .linear_key = "asymmetry",
                    .doc = "a: half the difference of the coefficients over their mean",
                    .lower = -0.95,
                    .upper = 0.95,
                    .starts = {0.1, -0.1}}},
    .shows = "the mean of forward and backward residual grows with the speed",
    .confused_with = {"coulomb_asymmetry", "constant_torque", "dac_offset", "tach_offset"},
    .separate_by = "three constant speeds or more each way",
    .origin = "oil pumped one way by screw or seals; amplifier gain that differs by sign",
    .remedy = "check seals and amplifier balance; compensate by direction",
    .install = install,
};

}  // namespace sim::effects
