// Friction curve that bends at speed.
#include <algorithm>
#include <cmath>

#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install([[maybe_unused]] const EffectEntry& entry, [[maybe_unused]] const DataSheet& data, Drive& drive) {
  // The reference speed only gives the coefficient a readable unit.
  const double reference = data.kind == DriveKind::rotary ? 10.0 : 0.1;
  const double coefficient = entry.at("coefficient"), exponent = entry.at("exponent");
  drive.sliding_friction.push_back([=](double speed) {
    // A law that flattens is infinitely steep at rest; below a thousandth of the reference its slope is held.
    const double ratio = speed / reference, steepest = std::max(ratio, 1e-3);
    const double at_steepest = coefficient * std::pow(steepest, exponent);
    const double effort =
        ratio == steepest ? at_steepest : (ratio > 0.0 ? coefficient * std::pow(ratio, exponent) : 0.0);
    return FrictionPoint{effort, exponent * at_steepest / (steepest * reference)};
  });
}

}  // namespace

extern const EffectInfo nonlinear_viscous;
const EffectInfo nonlinear_viscous{
    .kind = "nonlinear_viscous",
    .title = "Friction curve that bends at speed",
    .equation = "T_f = B w + c sign(w) (|w|/w_r)^p, w_r = 10 rad/s or 0.1 m/s",
    .stage = Stage::friction,

    .parameters = {{.id = "coefficient",
                    .rotary_key = "coefficient_Nm",
                    .linear_key = "coefficient_N",
                    .doc = "c: torque of the bend at the reference speed",
                    .lower = -1e5,
                    .upper = 1e5,
                    .scale = Scale::coulomb,
                    .starts = {0.1, -0.1}},
                   {.id = "exponent",
                    .rotary_key = "exponent",
                    .linear_key = "exponent",
                    .doc = "p: below 1 the curve flattens, above 1 it steepens",
                    .lower = 0.2,
                    .upper = 3.0,
                    .starts = {0.5, 2.0}}},
    .shows = "residual torque against speed curves at the plateaus, alike in both directions",
    .confused_with = {"thermal_friction_drift", "voltage_limit", "stribeck", "viscous_asymmetry"},
    .separate_by = "five constant speeds or more at one temperature, up to rapid traverse",
    .origin = "churning of grease, turbulent oil, fan losses of the motor",
    .remedy = "less grease or a lighter grade; take the curve into the feed-forward",
    .install = install,
};

}  // namespace sim::effects
