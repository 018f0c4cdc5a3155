// Nonlinear viscous friction.
#include <algorithm>
#include <cmath>

#include "sim/drive.hpp"
#include "sim/effect.hpp"
#include "sim/power.hpp"

namespace sim::effects {

namespace {

void install_nonlinear_viscous(const EffectEntry& entry, const DataSheet& data, Drive& drive) {
  // The reference speed only gives the coefficient a readable unit.
  const double reference = data.kind == DriveKind::rotary ? 10.0 : 0.1;
  const double coefficient = entry.at("coefficient");
  if (entry.has("saturation")) {
    const double saturation = entry.at("saturation");
    drive.sliding_friction.push_back([=](int, double speed) {
      const double rest = std::exp(-speed / saturation);
      return FrictionPoint{-coefficient * rest, coefficient * rest / saturation};
    });
    return;
  }
  const double exponent = entry.has("exponent") ? entry.at("exponent") : 1.0;
  const double per_reference = 1.0 / reference;
  drive.sliding_friction.push_back([=, power = Power(exponent)](int, double speed) {
    // A curve with p < 1 is infinitely steep at rest; below a thousandth of the reference its slope is kept constant.
    const double ratio = speed * per_reference, steepest = std::max(ratio, 1e-3);
    const double at_steepest = coefficient * power(steepest);
    const double effort = ratio == steepest ? at_steepest : (ratio > 0.0 ? coefficient * power(ratio) : 0.0);
    return FrictionPoint{effort, exponent * per_reference * at_steepest / steepest};
  });
}

}  // namespace

extern const EffectInfo nonlinear_viscous;
const EffectInfo nonlinear_viscous{
    .kind = "nonlinear_viscous",
    .title = "Nonlinear viscous friction",
    .equation =
        "T_f = T_coul + B |w| + c (|w|/w_r)^p, against the motion; reference speed w_r = 10 rad/s or 0.1 m/s. If w_s "
        "is given instead of p: T_f = T_coul + B |w| - c exp(-|w|/w_s)",
    .stage = Stage::friction,
    .parameters = {{.id = "coefficient",
                    .rotary_key = "coefficient_Nm",
                    .linear_key = "coefficient_N",
                    .doc = "c: nonlinear torque at the reference speed",
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
                    .starts = {0.5, 2.0},
                    .optional = true},
                   {.id = "saturation",
                    .rotary_key = "saturation_rad_s",
                    .linear_key = "saturation_m_s",
                    .doc = "w_s, instead of p: speed constant of friction that rises to its level",
                    .lower = 1e-6,
                    .upper = 1e4,
                    .scale = Scale::top_speed,
                    .starts = {0.1},
                    .optional = true}},
    .shows = "Residual torque at constant speeds is a curve over speed, equal in both directions",
    .along = {"speed"},
    .confused_with = {"thermal_friction_drift", "voltage_limit", "stribeck", "viscous_asymmetry", "tach_gain"},
    .separate_by =
        "Five or more constant speeds at one temperature, from creep to rapid traverse; slow speeds separate a "
        "flattening curve from Stribeck friction",
    .origin =
        "Churning grease, turbulent oil, fan losses (p above 1); shear-thinning grease, which flattens (on a public "
        "linear axis p of 1/3 to 1/2 was measured). 5 to 30 % at top speed (textbook)",
    .remedy = "Less grease or a lighter grade; include the curve in the feed-forward",
    .install = install_nonlinear_viscous,
};

}  // namespace sim::effects
