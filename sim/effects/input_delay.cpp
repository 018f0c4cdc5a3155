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
                    .doc = "d: time from command to torque, without the sample-and-hold of one period",
                    .lower = 0.0,
                    .upper = 0.025,
                    .starts = {0.001, 0.003}}},
    .shows =
        "Residual torque is proportional to jerk: everything is late by the same time; the correlation with the "
        "command peaks away from zero lag",
    .along = {"acceleration", "frequency"},
    .view = View::moment,
    .confused_with = {"current_loop_lag", "tach_lag", "friction_lag", "inertia"},
    .separate_by =
        "Log the motor current during a step at standstill: a dead time shifts the rise, a lag rounds it. With a "
        "single acceleration profile the fit takes it as inertia",
    .origin =
        "Field bus, converter cycle, time stamps of another clock: 0.1 to 2 ms (textbook); 0.9 ms was measured on a "
        "public linear axis",
    .remedy = "Shorter cycle; synchronise bus and converter; align the clocks of the log",
    .install = install_input_delay,
};

}  // namespace sim::effects
