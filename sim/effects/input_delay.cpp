// Dead time.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install_input_delay(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  drive.delay_s += entry.at("delay");
}

}  // namespace

extern const EffectInfo input_delay;
const EffectInfo input_delay{
    .kind = "input_delay",
    .title = "Dead time",
    .equation = "T(t) = K_t K_a u(t - d); u: command, K_a, K_t: gains of amplifier and motor",
    .stage = Stage::command,
    .parameters = {{.id = "delay",
                    .rotary_key = "delay_s",
                    .linear_key = "delay_s",
                    .doc =
                        "d: from the command to the torque; that a sample holds its command for a period comes on top",
                    .lower = 0.0,
                    .upper = 0.025,
                    .starts = {0.001, 0.003}}},
    .shows =
        "Residual torque in proportion to jerk: everything comes late by the same time; its correlation with the "
        "command peaks off zero",
    .along = {"acceleration", "frequency"},
    .confused_with = {"current_loop_lag", "tach_lag", "friction_lag", "inertia"},
    .separate_by =
        "Log the motor current: a step at standstill shows dead time as nothing at all, lag as a slope. With one "
        "acceleration profile only, it hides in the inertia",
    .origin =
        "Field bus, converter cycle, time stamps of another clock: 0.1 to 2 ms (textbook); 0.9 ms was measured on a "
        "public linear axis",
    .remedy = "Shorter cycle; synchronise bus and converter; align the clocks of the log",
    .install = install_input_delay,
};

}  // namespace sim::effects
