// Voltage limit.
#include <algorithm>

#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install_voltage_limit(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  const double stall = entry.at("stall"), no_load = entry.at("no_load_speed");
  drive.effort_limit.push_back([=](double effort, double w) {
    const double forward = std::max(0.0, stall * (1.0 - w / no_load));
    const double backward = std::max(0.0, stall * (1.0 + w / no_load));
    return std::clamp(effort, -backward, forward);
  });
}

}  // namespace

extern const EffectInfo voltage_limit;
const EffectInfo voltage_limit{
    .kind = "voltage_limit",
    .title = "Voltage limit",
    .equation =
        "-T_s (1 + w/w_0) <= T <= T_s (1 - w/w_0); w: shaft speed. The supply less the back-EMF drives the current",
    .stage = Stage::motor,
    .parameters = {{.id = "stall",
                    .rotary_key = "stall_Nm",
                    .linear_key = "stall_N",
                    .doc = "T_s: limit at standstill",
                    .lower = 1e-3,
                    .upper = 1e6,
                    .scale = Scale::stall_effort,
                    .starts = {1.0}},
                   {.id = "no_load_speed",
                    .rotary_key = "no_load_speed_rad_s",
                    .linear_key = "no_load_speed_m_s",
                    .doc = "w_0: speed at which back-EMF equals the supply",
                    .lower = 1e-3,
                    .upper = 1e5,
                    .scale = Scale::top_speed,
                    .starts = {1.5}}},
    .shows = "Residual appears only at high speed with torque in the direction of motion, not while braking",
    .along = {"speed", "current"},
    .confused_with = {"current_saturation", "nonlinear_viscous", "viscous", "thermal_friction_drift"},
    .separate_by = "Demand the same torque at low speed, and brake from top speed; log the bus voltage",
    .origin = "Supply voltage against back-EMF; sagging bus while several axes accelerate",
    .remedy = "Higher bus voltage or another winding; lower rapid traverse or its acceleration",
    .install = install_voltage_limit,
};

}  // namespace sim::effects
