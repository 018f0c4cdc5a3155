// Lag of the current loop.
#include <numbers>

#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install_current_loop_lag(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  drive.current_lag_s = 1.0 / (2.0 * std::numbers::pi * entry.at("bandwidth"));
}

}  // namespace

extern const EffectInfo current_loop_lag;
const EffectInfo current_loop_lag{
    .kind = "current_loop_lag",
    .title = "Lag of the current loop",
    .equation = "di/dt = 2 pi f (K_a u - i); i: current, u: command, K_a: gain of the amplifier",
    .stage = Stage::command,
    .parameters = {{.id = "bandwidth",
                    .rotary_key = "bandwidth_Hz",
                    .linear_key = "bandwidth_Hz",
                    .doc = "f",
                    .lower = 5.0,
                    .upper = 2000.0,
                    .starts = {50, 150}}},
    .shows = "Residual torque is proportional to jerk: every step of the command is rounded",
    .along = {"acceleration", "frequency"},
    .view = View::moment,
    .confused_with = {"input_delay", "tach_lag", "compliance", "inertia", "friction_lag"},
    .separate_by =
        "Log the motor current during a step at standstill: a lag rounds the rise, a dead time shifts it. In motion a "
        "lag and a delay of 1 ms look alike",
    .origin =
        "Gains of the current loop, winding inductance, low bus voltage: time constants of 0.1 to 2 ms (textbook)",
    .remedy = "Tune the current loop; raise the bus voltage",
    .install = install_current_loop_lag,
};

}  // namespace sim::effects
