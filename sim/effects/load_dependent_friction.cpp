// Friction that grows with the transmitted torque.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install([[maybe_unused]] const EffectEntry& entry, [[maybe_unused]] const DataSheet& data, Drive& drive) {
  drive.transmitted_share += entry.at("coefficient");
}

}  // namespace

extern const EffectInfo load_dependent_friction;
const EffectInfo load_dependent_friction{
    .kind = "load_dependent_friction",
    .title = "Friction that grows with the transmitted torque",
    .equation = "T_f = T_coul + mu |T_motor|",
    .stage = Stage::friction,

    .parameters = {{.id = "coefficient",
                    .rotary_key = "coefficient",
                    .linear_key = "coefficient",
                    .doc = "mu: part of the transmitted torque that is lost",
                    .lower = 0.0,
                    .upper = 0.9,
                    .starts = {0.05}}},
    .shows =
        "residual torque proportional to the motor torque, against the motion; more while motoring than while braking",
    .confused_with = {"dac_dead_zone", "inertia", "torque_ripple"},
    .separate_by = "two known loads at one speed; compare accelerating with braking",
    .origin = "efficiency of screw, gear or belt",
    .remedy = "check screw alignment and gear lubrication",
    .install = install,
};

}  // namespace sim::effects
