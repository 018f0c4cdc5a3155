// Coulomb friction that differs by direction.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install([[maybe_unused]] const EffectEntry& entry, [[maybe_unused]] const DataSheet& data, Drive& drive) {
  const double asymmetry = entry.at("asymmetry");
  drive.direction_factor[0].level *= 1.0 + asymmetry;
  drive.direction_factor[1].level *= 1.0 - asymmetry;
}

}  // namespace

extern const EffectInfo coulomb_asymmetry;
const EffectInfo coulomb_asymmetry{
    .kind = "coulomb_asymmetry",
    .title = "Coulomb friction that differs by direction",
    .equation = "T_coul+ = (1+a) T_coul, T_coul- = (1-a) T_coul; static friction alike",
    .stage = Stage::friction,

    .parameters = {{.id = "asymmetry",
                    .rotary_key = "asymmetry",
                    .linear_key = "asymmetry",
                    .doc = "a: half the difference of the levels over their mean",
                    .lower = -0.9,
                    .upper = 0.9,
                    .starts = {0.05, -0.05}}},
    .shows = "residual torque constant in each direction, of one sign, independent of the speed",
    .confused_with = {"constant_torque", "dac_offset", "viscous_asymmetry"},
    .separate_by =
        "hold the axis at rest with the coupling off, and turn the axis over: a constant torque stays while standing, "
        "asymmetry does not",
    .origin = "wiper lips, one-sided preload of a double nut, inclined guideway contact",
    .remedy = "check wipers and the nut preload in both directions",
    .install = install,
};

}  // namespace sim::effects
