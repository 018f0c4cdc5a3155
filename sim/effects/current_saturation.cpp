// Current limit.
#include <algorithm>

#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install_current_saturation(const EffectEntry& entry, const DataSheet& data, Drive& drive) {
  const double per_limit = data.kind == DriveKind::rotary ? data.torque_constant_Nm_per_A : 1.0;
  const double limit = per_limit * entry.at("limit");
  drive.effort_limit.push_back([limit](double effort, double) { return std::clamp(effort, -limit, limit); });
}

}  // namespace

extern const EffectInfo current_saturation;
const EffectInfo current_saturation{
    .kind = "current_saturation",
    .title = "Current limit",
    .equation = "-i_max <= i <= i_max; i: motor current",
    .stage = Stage::motor,
    .parameters = {{.id = "limit",
                    .rotary_key = "limit_A",
                    .linear_key = "limit_N",
                    .doc = "i_max (force limit of a linear drive)",
                    .lower = 1e-3,
                    .upper = 1e6,
                    .scale = Scale::stall_current,
                    .starts = {0.4, 0.6, 0.8}}},
    .shows =
        "Residual appears only at large commands, with a flat top: a larger command gives no more acceleration, in "
        "either direction",
    .along = {"current"},
    .confused_with = {"voltage_limit", "nonlinear_viscous", "torque_ripple"},
    .separate_by =
        "Repeat the motion at half the amplitude. If the limit also acts at low speed, it is not a voltage limit",
    .origin = "Peak or thermal limit of the amplifier, or a limit left over from commissioning",
    .remedy = "Raise the limit if motor and screw allow it; else lower acceleration and jerk of the reference",
    .install = install_current_saturation,
};

}  // namespace sim::effects
