// Elastic microslip before breakaway.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install_presliding(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  drive.bristles = Bristles{entry.at("sigma0"), entry.at("sigma1")};
}

}  // namespace

extern const EffectInfo presliding;
const EffectInfo presliding{
    .kind = "presliding",
    .title = "Elastic microslip before breakaway",
    .equation =
        "dz/dt = w - sigma0 |w| z/g(w), T_f = sigma0 z + sigma1 dz/dt + B w (LuGre); z: deflection of the contact, w: "
        "speed, g(w): friction curve without its viscous part",
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
    .shows =
        "Residual torque depends on the travel since the last reversal and fades within micrometres at any speed. The "
        "axis springs back when the torque is removed",
    .along = {"travel_since_reversal"},
    .view = View::moment,
    .confused_with = {"backlash", "compliance", "stribeck", "friction_lag"},
    .separate_by =
        "Triangular motion of a few micrometres at two rates and two amplitudes: presliding gives a loop that depends "
        "on travel, not on time; a gap gives free travel without torque",
    .origin =
        "Rolling guides, preloaded balls, seals that roll before they slip. Breakaway after 5 to 100 um on rolling "
        "guides (textbook)",
    .remedy = "Reversal compensation over the breakaway distance; less preload",
    .install = install_presliding,
};

}  // namespace sim::effects
