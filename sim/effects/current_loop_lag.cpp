// Lag of the current loop.
#include <numbers>

#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install([[maybe_unused]] const EffectEntry& entry, [[maybe_unused]] const DataSheet& data, Drive& drive) {
  drive.current_lag_s = 1.0 / (2.0 * std::numbers::pi * entry.at("bandwidth"));
}

}  // namespace

extern const EffectInfo current_loop_lag;
const EffectInfo current_loop_lag{
    .kind = "current_loop_lag",
    .title = "Lag of the current loop",
    .equation = "di/dt = 2 pi f (K_a u - i)",
    .stage = Stage::command,

    .parameters = {{.id = "bandwidth",
                    .rotary_key = "bandwidth_Hz",
                    .linear_key = "bandwidth_Hz",
                    .doc = "f",
                    .lower = 5.0,
                    .upper = 2000.0,
                    .starts = {50, 150}}},
    .shows = "residual torque proportional to jerk, rounding off every step of the command",
    .confused_with = {"input_delay", "tach_lag", "compliance", "inertia"},
    .separate_by = "log the motor current; a step at standstill shows dead time and lag apart",
    .origin = "gains of the current loop, winding inductance, low bus voltage",
    .remedy = "tune the current loop",
    .install = install,
};

}  // namespace sim::effects
