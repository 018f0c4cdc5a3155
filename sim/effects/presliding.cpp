// Elastic microslip before breakaway.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install([[maybe_unused]] const EffectEntry& entry, [[maybe_unused]] const DataSheet& data, Drive& drive) {
  drive.bristles = Bristles{entry.at("sigma0"), entry.at("sigma1")};
}

}  // namespace

extern const EffectInfo presliding;
const EffectInfo presliding{
    .kind = "presliding",
    .title = "Elastic microslip before breakaway",
    .equation = "dz/dt = w - sigma0 |w| z / g(w), T_f = sigma0 z + sigma1 dz/dt + B w (LuGre)",
    .stage = Stage::friction,

    .parameters = {{.id = "sigma0",
                    .rotary_key = "sigma0_Nm_per_rad",
                    .linear_key = "sigma0_N_per_m",
                    .doc = "stiffness of the contact",
                    .lower = 1e-3,
                    .upper = 1e9,
                    .scale = Scale::bristle_stiffness,
                    .starts = {1, 5}},
                   {.id = "sigma1",
                    .rotary_key = "sigma1_Nm_s_per_rad",
                    .linear_key = "sigma1_N_s_per_m",
                    .doc = "damping of the contact",
                    .lower = 0.0,
                    .upper = 1e6,
                    .scale = Scale::bristle_damping,
                    .starts = {1}}},
    .shows = "residual torque against the travel since the last reversal, fading over some micrometres, at any rate",
    .confused_with = {"backlash", "compliance", "stribeck", "friction_lag"},
    .separate_by = "triangles of a few micrometres at two rates and two amplitudes",
    .origin = "rolling guides, preloaded balls, seals that roll before they slip",
    .remedy = "reversal compensation that knows the breakaway distance",
    .install = install,
};

}  // namespace sim::effects
