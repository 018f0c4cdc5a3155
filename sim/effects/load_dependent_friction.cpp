// Friction that grows with the transmitted torque.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install_load_dependent_friction(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  drive.transmitted_share += entry.at("coefficient");
}

}  // namespace

extern const EffectInfo load_dependent_friction;
const EffectInfo load_dependent_friction{
    .kind = "load_dependent_friction",
    .title = "Friction that grows with the transmitted torque",
    .equation = "T_f = T_coul + B |w| + mu |T_motor|, against the motion; T_motor: motor torque",
    .stage = Stage::friction,
    .parameters = {{.id = "coefficient",
                    .rotary_key = "coefficient",
                    .linear_key = "coefficient",
                    .doc = "mu: share of the transmitted torque that is lost",
                    .lower = 0.0,
                    .upper = 0.9,
                    .starts = {0.05}}},
    .shows =
        "Residual torque is proportional to the motor torque and opposes the motion. It adds to the load when driving "
        "and helps when braking, so the apparent inertias differ",
    .along = {"current"},
    .confused_with = {"dac_dead_zone", "inertia", "torque_ripple", "coulomb"},
    .separate_by =
        "Two known loads at one speed; or one profile with two accelerations, comparing acceleration with braking",
    .origin =
        "Efficiency of screw, gear or belt: 5 to 15 % of the torque in ball screws, more in strain-wave gears "
        "(textbook)",
    .remedy = "Check screw alignment, nut and gear lubrication",
    .install = install_load_dependent_friction,
};

}  // namespace sim::effects
