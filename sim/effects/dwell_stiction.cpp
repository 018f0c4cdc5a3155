// Static friction that grows with rest.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install_dwell_stiction(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  drive.dwell_gain = entry.at("gain");
  drive.dwell_time_s = entry.at("time_constant");
}

}  // namespace

extern const EffectInfo dwell_stiction;
const EffectInfo dwell_stiction{
    .kind = "dwell_stiction",
    .title = "Static friction that grows with rest",
    .equation = "T_stat(t) = T_stat (1 + g (1 - exp(-t/tau))); t: time at rest before the start",
    .stage = Stage::friction,
    .parameters = {{.id = "gain",
                    .rotary_key = "gain",
                    .linear_key = "gain",
                    .doc = "g: growth of the static friction after a long rest",
                    .lower = 0.0,
                    .upper = 5.0,
                    .starts = {0.5, 0.15}},
                   {.id = "time_constant",
                    .rotary_key = "time_constant_s",
                    .linear_key = "time_constant_s",
                    .doc = "tau",
                    .lower = 0.01,
                    .upper = 1000.0,
                    .starts = {0.3, 2.0}}},
    .shows =
        "The first breakaway after a rest needs more torque; the excess grows with the length of the rest. Starts "
        "after short stops are not affected",
    .along = {"rest"},
    .view = View::starts,
    .confused_with = {"stribeck", "thermal_friction_drift", "presliding", "position_dependent_friction"},
    .separate_by =
        "Rest 0.1, 1, 10 and 100 s at one place before the same slow ramp; change the ramp rate to rule out a lag",
    .origin = "Oil squeezed out of the contact, wipers that adhere. 5 to 50 % more, over decades of seconds (textbook)",
    .remedy =
        "Small oscillation (a few micrometres) during long rests; lubrication pulse before the start; hydrostatic or "
        "rolling guides",
    .install = install_dwell_stiction,
};

}  // namespace sim::effects
