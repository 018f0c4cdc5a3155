// Frictional memory.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install_friction_lag(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  drive.friction_memory_s = entry.at("time");
}

}  // namespace

extern const EffectInfo friction_lag;
const EffectInfo friction_lag{
    .kind = "friction_lag",
    .title = "Frictional memory",
    .equation =
        "tau dv/dt = |w| - v, T_f = F(v) + B |w|, against the motion; w: speed, F: friction curve of eq. (19) without "
        "its viscous part",
    .stage = Stage::friction,
    .parameters = {{.id = "time",
                    .rotary_key = "time_s",
                    .linear_key = "time_s",
                    .doc = "tau",
                    .lower = 1e-4,
                    .upper = 0.5,
                    .starts = {0.005, 0.03}}},
    .shows =
        "A loop of residual torque over speed while sliding at low speed, wider at higher frequency. Friction is "
        "higher while speeding up than while slowing down",
    .along = {"speed", "acceleration"},
    .confused_with = {"input_delay", "presliding", "stribeck", "current_loop_lag"},
    .separate_by =
        "A sine on a bias that never reverses, at several frequencies: the loop widens in time, not in travel. Without "
        "friction that falls with speed there is nothing to see",
    .origin = "The lubricant film needs time to build up and to drain: 1 to 50 ms (textbook)",
    .remedy = "Thinner oil; avoid quick changes of speed at creep",
    .install = install_friction_lag,
};

}  // namespace sim::effects
