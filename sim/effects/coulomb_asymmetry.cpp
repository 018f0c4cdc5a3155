// Coulomb friction that differs by direction.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install_coulomb_asymmetry(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  const double asymmetry = entry.at("asymmetry");
  drive.direction_factor[0].level *= 1.0 + asymmetry;
  drive.direction_factor[1].level *= 1.0 - asymmetry;
}

}  // namespace

extern const EffectInfo coulomb_asymmetry;
const EffectInfo coulomb_asymmetry{
    .kind = "coulomb_asymmetry",
    .title = "Coulomb friction that differs by direction",
    .equation =
        "T_coul+ = (1 + a) T_coul, T_coul- = (1 - a) T_coul, static friction scales alike; +: forward, -: backward",
    .stage = Stage::friction,
    .parameters = {{.id = "asymmetry",
                    .rotary_key = "asymmetry",
                    .linear_key = "asymmetry",
                    .doc = "a: half the difference of the levels over their mean",
                    .lower = -0.9,
                    .upper = 0.9,
                    .starts = {0.05, -0.05}}},
    .shows =
        "Residual torque is constant while the axis moves, with the same sign in both directions. Where friction falls "
        "with speed, the asymmetry falls with it; an offset does not",
    .along = {"speed"},
    .confused_with = {"constant_torque", "dac_offset", "viscous_asymmetry"},
    .separate_by =
        "In motion it looks like a constant torque. Hold the axis at rest with the coupling off, or turn the axis "
        "over: a constant torque also acts at rest, friction only against motion",
    .origin = "Wiper lips, one-sided preload of a double nut, tilted gibs. 2 to 20 % of the level (textbook)",
    .remedy = "Check wipers and the nut's preload in both directions; feed friction forward by direction",
    .install = install_coulomb_asymmetry,
};

}  // namespace sim::effects
