// Inertia.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install_inertia(const EffectEntry& entry, const DataSheet&, Drive& drive) { drive.inertia = entry.at("J"); }

}  // namespace

extern const EffectInfo inertia;
const EffectInfo inertia{
    .kind = "inertia",
    .title = "Inertia",
    .equation = "J dw/dt = T - T_f (eq. 1); w: shaft speed, T: motor torque, T_f: friction. Linear: mass, m/s, N",
    .stage = Stage::mechanics,
    .base = true,
    .parameters = {{.id = "J",
                    .rotary_key = "J_kg_m2",
                    .linear_key = "M_kg",
                    .doc = "total moving inertia, referred to the motor",
                    .lower = 1e-11,  // rotors of the smallest motors: about 5e-10
                    .upper = 1e6,
                    .scale = Scale::inertia,
                    .starts = {1}}},
    .shows = "Residual torque is proportional to acceleration, equal in both directions, and zero at constant speed",
    .along = {"acceleration"},
    .confused_with = {"current_loop_lag", "tach_gain", "input_delay", "load_dependent_friction"},
    .separate_by =
        "Two acceleration levels at the same speeds: inertia torque is proportional to acceleration, a lag to jerk. A "
        "known mass added to the table must appear in full",
    .origin =
        "Rotor, coupling, screw, table, workpiece. A payload changes it by 1 to 30 % (textbook). A wrong torque "
        "constant scales it and every friction value by the same factor",
    .remedy = "Enter the payload, or identify again after a change of workpiece or fixture",
    .install = install_inertia,
};

}  // namespace sim::effects
