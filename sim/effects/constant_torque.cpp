// Constant torque.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install([[maybe_unused]] const EffectEntry& entry, [[maybe_unused]] const DataSheet& data, Drive& drive) {
  const double torque = entry.at("torque");
  drive.load_effort.push_back([torque](double, double) { return torque; });
}

}  // namespace

extern const EffectInfo constant_torque;
const EffectInfo constant_torque{
    .kind = "constant_torque",
    .title = "Constant torque",
    .equation = "T = T_motor + T_0",
    .stage = Stage::load,

    .parameters = {{.id = "torque",
                    .rotary_key = "torque_Nm",
                    .linear_key = "force_N",
                    .doc = "T_0, the same in both directions and at rest",
                    .lower = -1e6,
                    .upper = 1e6,
                    .scale = Scale::coulomb,
                    .starts = {0.05, -0.05}}},
    .shows = "residual torque constant, of one sign in both directions",
    .confused_with = {"coulomb_asymmetry", "dac_offset", "viscous_asymmetry", "spring_torque"},
    .separate_by =
        "hold the axis at rest without friction in play (coupling off); turn the axis over; read the current at zero "
        "command",
    .origin = "gravity on an inclined or vertical axis, a counterweight out of balance",
    .remedy = "trim the counterweight; feed the weight forward",
    .install = install,
};

}  // namespace sim::effects
