// A second mass on a spring.
#include "sim/drive.hpp"
#include "sim/effect.hpp"
#include "sim/second_mass.hpp"

namespace sim::effects {

namespace {

void install_compliance(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  drive.second_mass = second_mass_of(entry);
}

}  // namespace

extern const EffectInfo compliance;
const EffectInfo compliance{
    .kind = "compliance",
    .title = "A second mass on a spring",
    .equation =
        "J1 dw1/dt = T - s - (1 - p) T_d - (1 - q) T_v, J2 dw2/dt = s - p T_d - q T_v, s = k d + c dd/dt; 1: motor, 2: "
        "load behind the spring, d: twist, T_d, T_v: dry and viscous friction at the speed of its side, p, q: their "
        "shares on the load, default 1 and p; k, c from resonance and damping",
    .stage = Stage::mechanics,
    .parameters = {{.id = "resonance",
                    .rotary_key = "resonance_Hz",
                    .linear_key = "resonance_Hz",
                    .doc = "of both masses on the spring, free to move",
                    .lower = 2.0,
                    .upper = 300.0,
                    .starts = {50.0, 130.0}},
                   {.id = "damping_ratio",
                    .rotary_key = "damping_ratio",
                    .linear_key = "damping_ratio",
                    .doc = "of that mode",
                    .lower = 0.001,
                    .upper = 1.0,
                    .starts = {0.05},
                    .absent_at_lower = true},
                   {.id = "load_fraction",
                    .rotary_key = "load_fraction",
                    .linear_key = "load_fraction",
                    .doc = "share of the inertia behind the spring",
                    .lower = 0.02,
                    .upper = 0.95,
                    .starts = {0.35}},
                   load_friction_parameter(),
                   load_viscous_parameter()},
    .shows =
        "Residual oscillates at one frequency after each change of torque, at any speed. Both inertias act below the "
        "resonance, only the motor's above it",
    .along = {"frequency", "acceleration"},
    .view = View::moment,
    .confused_with = {"backlash", "presliding", "current_loop_lag", "tach_ripple"},
    .separate_by =
        "Swept sine with encoders on motor and table: the frequency of a resonance is constant, that of ripple follows "
        "speed; with a gap the frequency depends on amplitude",
    .origin =
        "Coupling, screw and nut, thrust bearing, belt; the first axial mode of a screw drive lies at 30 to 300 Hz "
        "(textbook)",
    .remedy = "Stiffer coupling or bearing; notch filter; limit the jerk",
    .install = install_compliance,
};

}  // namespace sim::effects
