// Constant torque.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install_constant_torque(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  const double torque = entry.at("torque");
  drive.load_effort.push_back([torque](double, double) { return torque; });
}

}  // namespace

extern const EffectInfo constant_torque;
const EffectInfo constant_torque{
    .kind = "constant_torque",
    .title = "Constant torque",
    .equation = "T = T_motor + T_0; acts in both directions and at rest",
    .stage = Stage::load,
    .parameters = {{.id = "torque",
                    .rotary_key = "torque_Nm",
                    .linear_key = "force_N",
                    .doc = "T_0, the same in both directions and at rest",
                    .lower = -1e6,
                    .upper = 1e6,
                    .scale = Scale::coulomb,
                    .starts = {0.05, -0.05}}},
    .shows =
        "Residual torque is constant, with the same sign in both directions. A released axis moves by itself unless "
        "friction holds it",
    .along = {"speed"},
    .confused_with = {"coulomb_asymmetry", "dac_offset", "viscous_asymmetry", "spring_torque"},
    .separate_by =
        "Hold the axis at rest with the coupling off, so that no friction acts; turn the axis over; read the motor "
        "current at zero command to rule out an offset of the electronics",
    .origin = "Gravity on an inclined or vertical axis, a counterweight out of balance, a cable under tension",
    .remedy = "Trim the counterweight; feed the weight forward",
    .install = install_constant_torque,
};

}  // namespace sim::effects
