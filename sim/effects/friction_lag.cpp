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
        "Residual torque over speed forms a loop at low sliding speed, wider at higher frequency. Friction is higher "
        "during acceleration than during deceleration",
    .along = {"speed", "acceleration"},
    .view = View::moment,
    .confused_with = {"input_delay", "presliding", "stribeck", "current_loop_lag"},
    .separate_by =
        "Sine on a bias speed without reversal, at several frequencies: the loop depends on time, not on travel. It is "
        "visible only where friction falls with speed",
    .origin = "Time for the lubricant film to build up and drain: 1 to 50 ms (textbook)",
    .remedy = "Thinner oil; avoid rapid changes of speed at creep",
    .install = install_friction_lag,
};

}  // namespace sim::effects
