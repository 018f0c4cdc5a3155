// Coulomb friction.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install_coulomb(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  drive.friction[0].coulomb += entry.either("positive", "level");
  drive.friction[1].coulomb += entry.either("negative", "level");
}

}  // namespace

extern const EffectInfo coulomb;
const EffectInfo coulomb{
    .kind = "coulomb",
    .title = "Coulomb friction",
    .equation =
        "T_f = T_coul+ for w > 0, T_coul- for w < 0 (eqs. 28 to 30); at rest it holds any torque between the two",
    .stage = Stage::friction,
    .base = true,
    .parameters = {{.id = "positive",
                    .rotary_key = "positive_Nm",
                    .linear_key = "positive_N",
                    .doc = "level while moving forward",
                    .lower = 0.0,
                    .upper = 1e6,
                    .scale = Scale::coulomb,
                    .starts = {1},
                    .optional = true},
                   {.id = "negative",
                    .rotary_key = "negative_Nm",
                    .linear_key = "negative_N",
                    .doc = "level while moving backward, negative",
                    .lower = -1e6,
                    .upper = 0.0,
                    .scale = Scale::coulomb,
                    .starts = {-1},
                    .optional = true},
                   {.id = "level",
                    .rotary_key = "level_Nm",
                    .linear_key = "level_N",
                    .doc = "one level for both directions",
                    .lower = 0.0,
                    .upper = 1e6,
                    .scale = Scale::coulomb,
                    .starts = {1},
                    .optional = true,
                    .pair_of = "positive negative"}},
    .shows = "Residual torque is constant in each direction at any speed and jumps at every reversal",
    .along = {"speed"},
    .confused_with = {"constant_torque", "dac_offset", "coulomb_asymmetry", "dac_dead_zone"},
    .separate_by =
        "Constant speeds in both directions: half the difference of forward and backward torque, extrapolated to zero "
        "speed, is the level; half their sum is an offset",
    .origin = "Guideways, wipers, preloaded nut and bearings",
    .remedy = "Check preload, wipers and gib adjustment; feed the level forward",
    .install = install_coulomb,
};

}  // namespace sim::effects
