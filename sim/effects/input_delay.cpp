// Dead time.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install([[maybe_unused]] const EffectEntry& entry, [[maybe_unused]] const DataSheet& data, Drive& drive) {
  drive.delay_s += entry.at("delay");
}

}  // namespace

extern const EffectInfo input_delay;
const EffectInfo input_delay{
    .kind = "input_delay",
    .title = "Dead time",
    .equation = "T(t) = K_t K_a u(t - d)",
    .stage = Stage::command,

    .parameters = {{.id = "delay",
                    .rotary_key = "delay_s",
                    .linear_key = "delay_s",
                    .doc = "d: from the command to the torque",
                    .lower = 0.0,
                    .upper = 0.025,
                    .starts = {0.001, 0.003}}},
    .shows = "residual torque proportional to jerk: everything comes late by the same time",
    .confused_with = {"current_loop_lag", "tach_lag", "friction_lag", "inertia"},
    .separate_by = "log the motor current; a step at standstill shows dead time and lag apart",
    .origin = "field bus, converter cycle, time stamps of another clock",
    .remedy = "shorter cycle; synchronise bus and converter",
    .install = install,
};

}  // namespace sim::effects
