// Temporary external torque.
#include <algorithm>

#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install_external_torque(const EffectEntry& entry, const DataSheet& data, Drive& drive) {
  const double torque = entry.at("torque"), start = entry.at("start"), end = start + entry.at("duration");
  // The torque is weighted by the part of the sample in which it acts: a fit can move the edges by less than a sample.
  const double period_s = data.sample_period_s;
  const auto acting = [=](double t_s) {
    return torque * std::max(0.0, std::min(t_s + period_s, end) - std::max(t_s, start)) / period_s;
  };
  if (data.kind == DriveKind::linear)
    drive.load_effort.push_back([=](double t_s, double) { return acting(t_s); });
  else
    drive.effort_behind_screw.emplace_back(acting);
}

}  // namespace

extern const EffectInfo external_torque;
const EffectInfo external_torque{
    .kind = "external_torque",
    .title = "Temporary external torque",
    .equation =
        "T = T_motor + T_e for t_0 <= t < t_0 + d; t: time on the clock of the record. A rotary drive has a "
        "self-locking "
        "screw: at rest T_e only takes from T_motor",
    .stage = Stage::load,
    .parameters = {{.id = "torque",
                    .rotary_key = "torque_Nm",
                    .linear_key = "force_N",
                    .doc = "T_e",
                    .lower = -1e6,
                    .upper = 1e6,
                    .scale = Scale::coulomb,
                    .starts = {0.3, -0.3}},
                   {.id = "start",
                    .rotary_key = "start_s",
                    .linear_key = "start_s",
                    .doc = "t_0, on the clock of the record",
                    .lower = 0.0,
                    .upper = 1e6,
                    .scale = Scale::duration,
                    .starts = {0.25, 0.5, 0.75}},
                   {.id = "duration",
                    .rotary_key = "duration_s",
                    .linear_key = "duration_s",
                    .doc = "d",
                    .lower = 1e-3,
                    .upper = 1e6,
                    .scale = Scale::duration,
                    .starts = {0.05}}},
    .shows = "Residual torque within one interval of time, independent of the motion; none before and after",
    .along = {"time"},
    .confused_with = {"thermal_friction_drift", "position_dependent_friction"},
    .separate_by =
        "Run the same programme again without cutting and with nobody at the machine: a temporary torque does not "
        "repeat",
    .origin = "Cutting force, a collision, a chip, somebody leaning on the table",
    .remedy = "Leave that interval out of the fit; do not let it affect a friction model",
    .install = install_external_torque,
};

}  // namespace sim::effects
