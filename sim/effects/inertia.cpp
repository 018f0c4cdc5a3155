// Inertia.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install([[maybe_unused]] const EffectEntry& entry, [[maybe_unused]] const DataSheet& data, Drive& drive) {
  drive.inertia = entry.at("J");
}

}  // namespace

extern const EffectInfo inertia;
const EffectInfo inertia{
    .kind = "inertia",
    .title = "Inertia",
    .equation = "J dw/dt = T (eq. 1)",
    .stage = Stage::mechanics,
    .base = true,
    .parameters = {{.id = "J",
                    .rotary_key = "J_kg_m2",
                    .linear_key = "M_kg",
                    .doc = "inertia of everything that moves, seen at the motor",
                    .lower = 1e-7,
                    .upper = 1e6,
                    .scale = Scale::inertia,
                    .starts = {1}}},
    .shows = "residual torque proportional to acceleration, of the same sign in both directions",
    .confused_with = {"current_loop_lag", "tach_gain", "input_delay"},
    .separate_by = "two acceleration levels at the same speeds; a known mass added to the table",
    .origin = "rotor, coupling, screw, table, workpiece",
    .remedy = "enter the payload, or identify again after a change of workpiece",
    .install = install,
};

}  // namespace sim::effects
