// Friction that varies along the travel.
#include <algorithm>

#include "sim/drive.hpp"
#include "sim/effect.hpp"
#include "sim/harmonic.hpp"

namespace sim::effects {

namespace {

void install_position_dependent_friction(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  const Harmonics harmonic(entry);
  drive.finest_period = std::min(drive.finest_period, harmonic.finest_period());
  drive.level_factor.push_back([harmonic](double, double x) { return std::max(0.0, 1.0 + harmonic(x)); });
}

}  // namespace

extern const EffectInfo position_dependent_friction;
const EffectInfo position_dependent_friction{
    .kind = "position_dependent_friction",
    .title = "Friction that varies along the travel",
    .equation =
        "T_f(x) = T_f (1 + c cos(2 pi x/L) + s sin(2 pi x/L)), and further orders of L; x: travel, T_f: Coulomb and "
        "static friction",
    .stage = Stage::friction,
    .periodic = true,
    .parameters = {{.id = "cosine",
                    .rotary_key = "cosine",
                    .linear_key = "cosine",
                    .doc = "c, relative",
                    .lower = -0.95,
                    .upper = 0.95,
                    .starts = {0.03}},
                   {.id = "sine",
                    .rotary_key = "sine",
                    .linear_key = "sine",
                    .doc = "s, relative",
                    .lower = -0.95,
                    .upper = 0.95,
                    .starts = {0.03}},
                   {.id = "period",
                    .rotary_key = "period_mm",
                    .linear_key = "period_m",
                    .doc = "L: much longer than a screw turn; a long L represents a slope",
                    .lower = 1e-4,
                    .upper = 1e5,
                    .scale = Scale::travel,
                    .starts = {0.3, 0.6, 1.0, 2.0}}},
    .shows = "Half the difference of forward and backward torque depends on position; half the sum does not",
    .along = {"position"},
    .confused_with = {"thermal_friction_drift", "spring_torque", "cogging", "load_dependent_friction"},
    .separate_by =
        "Constant speed over the full stroke, twice in each direction: a pattern that repeats at the same place "
        "depends on position, a drift from pass to pass on temperature",
    .origin =
        "Guideway wear in the middle of the stroke, gib or rail misalignment, bent screw. 10 to 30 % of the level "
        "(textbook)",
    .remedy = "Check straightness, gib and lubrication where friction is high",
    .install = install_position_dependent_friction,
};

}  // namespace sim::effects
