// Frictional memory.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install([[maybe_unused]] const EffectEntry& entry, [[maybe_unused]] const DataSheet& data, Drive& drive) {
  drive.friction_memory_s = entry.at("time");
}

}  // namespace

extern const EffectInfo friction_lag;
const EffectInfo friction_lag{
    .kind = "friction_lag",
    .title = "Frictional memory",
    .equation = "friction follows the speed through a lag: tau dv/dt = w - v, T_f = F(|v|) sign(w)",
    .stage = Stage::friction,

    .parameters = {{.id = "time",
                    .rotary_key = "time_s",
                    .linear_key = "time_s",
                    .doc = "tau",
                    .lower = 1e-4,
                    .upper = 0.5,
                    .starts = {0.005, 0.03}}},
    .shows = "a loop of residual torque against speed while sliding, wider at higher frequency",
    .confused_with = {"input_delay", "presliding", "stribeck", "current_loop_lag"},
    .separate_by = "a biased sine that never reverses, at several frequencies",
    .origin = "the lubricant film needs time to build up and to drain",
    .remedy = "thinner oil; avoid fast speed changes at low speed",
    .install = install,
};

}  // namespace sim::effects
