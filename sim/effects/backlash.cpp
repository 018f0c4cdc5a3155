// Backlash.
#include "sim/drive.hpp"
#include "sim/effect.hpp"
#include "sim/second_mass.hpp"

namespace sim::effects {

namespace {

void install_backlash(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  drive.second_mass = second_mass_of(entry);
}

}  // namespace

extern const EffectInfo backlash;
const EffectInfo backlash{
    .kind = "backlash",
    .title = "Backlash",
    .equation = "as compliance, with s = 0 while the twist is within +-e/2, and a contact that pushes but never pulls",
    .stage = Stage::mechanics,
    .parameters = {{.id = "gap",
                    .rotary_key = "gap_mm",
                    .linear_key = "gap_m",
                    .doc = "e: free travel of the table",
                    .lower = 0.0,
                    .upper = 5.0,
                    .scale = Scale::millimetre,
                    .starts = {0.01, 0.02, 0.04, 0.08, 0.16}},  // a gap of the wrong size fits worse than no gap
                   {.id = "resonance",
                    .rotary_key = "resonance_Hz",
                    .linear_key = "resonance_Hz",
                    .doc = "of both masses in contact",
                    .lower = 5.0,
                    .upper = 300.0,
                    .starts = {60, 150},
                    .absent_at_upper = true},
                   {.id = "damping_ratio",
                    .rotary_key = "damping_ratio",
                    .linear_key = "damping_ratio",
                    .doc = "of that mode",
                    .lower = 0.001,
                    .upper = 1.0,
                    .starts = {0.05, 0.6},  // a spring behind the gap, or hard contact
                    .absent_at_lower = true},
                   {.id = "load_fraction",
                    .rotary_key = "load_fraction",
                    .linear_key = "load_fraction",
                    .doc = "share of the inertia behind the gap",
                    .lower = 0.02,
                    .upper = 0.95,
                    .starts = {0.35}},
                   load_friction_parameter(),
                   load_viscous_parameter()},
    .shows =
        "After a reversal the motor moves freely over a fixed travel, then hits the load: the residual torque dips, "
        "then peaks. The travel is the same at any speed",
    .along = {"travel_since_reversal", "current"},
    .view = View::moment,
    .confused_with = {"compliance", "presliding", "input_delay"},
    .separate_by =
        "Encoders on motor and table. Reversals under a bias load, which closes the gap: backlash disappears, and a "
        "gradual recovery indicates presliding or wind-up",
    .origin =
        "Worn nut, key, coupling, gear or rack: up to 20 um in a ball screw, 10 to 200 um in racks and worm gears "
        "(textbook)",
    .remedy = "Replace or preload the nut; clamp the coupling; backlash compensation",
    .install = install_backlash,
};

}  // namespace sim::effects
