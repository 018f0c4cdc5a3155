// Torque that grows with position.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install_spring_torque(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  const double stiffness = entry.at("stiffness"), centre = entry.at("centre");
  drive.load_effort.push_back([=](double, double x) { return -stiffness * (x - centre); });
}

}  // namespace

extern const EffectInfo spring_torque;
const EffectInfo spring_torque{
    .kind = "spring_torque",
    .title = "Torque that grows with position",
    .equation = "T = T_motor - k (x - x0); x: travel",
    .stage = Stage::load,
    .parameters = {{.id = "stiffness",
                    .rotary_key = "stiffness_Nm_per_mm",
                    .linear_key = "stiffness_N_per_m",
                    .doc = "k",
                    .lower = -1e7,
                    .upper = 1e7,
                    .scale = Scale::coulomb_per_travel,
                    .starts = {0.1, -0.1}},
                   {.id = "centre",
                    .rotary_key = "centre_mm",
                    .linear_key = "centre_m",
                    .doc = "x0: position at which the spring is relaxed",
                    .lower = -1e5,
                    .upper = 1e5,
                    .scale = Scale::position,
                    .starts = {0.0}}},
    .shows = "The mean of forward and backward residual torque is linear in position",
    .along = {"position"},
    .confused_with = {"position_dependent_friction", "constant_torque", "coulomb_asymmetry"},
    .separate_by =
        "Slow strokes over the full travel in both directions, with the cable chain or bellows connected and "
        "disconnected",
    .origin = "Cable chain, bellows, hoses: 5 to 50 N at the table (textbook)",
    .remedy = "Relieve the cable chain; include the slope in the feed-forward",
    .install = install_spring_torque,
};

}  // namespace sim::effects
