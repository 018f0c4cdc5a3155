// Backlash.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install([[maybe_unused]] const EffectEntry& entry, [[maybe_unused]] const DataSheet& data, Drive& drive) {
  drive.second_mass =
      SecondMass{entry.at("load_fraction"), entry.at("resonance"), entry.at("damping_ratio"), entry.at("gap")};
}

}  // namespace

extern const EffectInfo backlash;
const EffectInfo backlash{
    .kind = "backlash",
    .title = "Backlash",
    .equation = "as compliance, with d = the twist beyond a gap of +-e/2",
    .stage = Stage::mechanics,

    .parameters = {{.id = "gap",
                    .rotary_key = "gap_mm",
                    .linear_key = "gap_m",
                    .doc = "e: free travel of the table",
                    .lower = 0.0,
                    .upper = 5.0,
                    .scale = Scale::millimetre,
                    .starts = {0.03}},
                   {.id = "resonance",
                    .rotary_key = "resonance_Hz",
                    .linear_key = "resonance_Hz",
                    .doc = "of both masses in contact",
                    .lower = 5.0,
                    .upper = 1000.0,
                    .starts = {60, 150}},
                   {.id = "damping_ratio",
                    .rotary_key = "damping_ratio",
                    .linear_key = "damping_ratio",
                    .doc = "of that mode",
                    .lower = 0.001,
                    .upper = 1.0,
                    .starts = {0.05}},
                   {.id = "load_fraction",
                    .rotary_key = "load_fraction",
                    .linear_key = "load_fraction",
                    .doc = "part of the inertia behind the gap",
                    .lower = 0.02,
                    .upper = 0.95,
                    .starts = {0.35}}},
    .shows = "after a reversal the motor runs free for a fixed travel, then hits the load",
    .confused_with = {"compliance", "presliding"},
    .separate_by = "two encoders; reversal under a bias load, which closes the gap",
    .origin = "worn nut, key, coupling, gear or rack",
    .remedy = "preload the nut; backlash compensation",
    .install = install,
};

}  // namespace sim::effects
