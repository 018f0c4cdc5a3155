// Stribeck friction.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install_stribeck(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  const auto set = [&entry](FrictionSide& side, const char* level, const char* omega1, const char* omega2) {
    side.breakaway += entry.either(level, "static");
    side.omega1 = entry.either(omega1, "omega1");
    side.omega2 = entry.either(omega2, "omega2");
  };
  set(drive.friction[0], "static_positive", "omega1_positive", "omega2_positive");
  set(drive.friction[1], "static_negative", "omega1_negative", "omega2_negative");
}

}  // namespace

extern const EffectInfo stribeck;
const EffectInfo stribeck{
    .kind = "stribeck",
    .title = "Stribeck friction",
    .equation =
        "T_f = T_stat exp(-|w|/W1) + T_coul (1 - exp(-|w|/W2)) + B |w|, against the motion (eq. 19); w: shaft speed",
    .stage = Stage::friction,
    .parameters = {{.id = "static_positive",
                    .rotary_key = "static_positive_Nm",
                    .linear_key = "static_positive_N",
                    .doc = "static friction forward",
                    .lower = 0.0,
                    .upper = 1e6,
                    .scale = Scale::coulomb,
                    .starts = {1.4},
                    .optional = true},
                   {.id = "static_negative",
                    .rotary_key = "static_negative_Nm",
                    .linear_key = "static_negative_N",
                    .doc = "static friction backward, negative",
                    .lower = -1e6,
                    .upper = 0.0,
                    .scale = Scale::coulomb,
                    .starts = {-1.4},
                    .optional = true},
                   {.id = "static",
                    .rotary_key = "static_Nm",
                    .linear_key = "static_N",
                    .doc = "static friction, both directions",
                    .lower = 0.0,
                    .upper = 1e6,
                    .scale = Scale::coulomb,
                    .starts = {1.4},
                    .optional = true,
                    .pair_of = "static_positive static_negative"},
                   {.id = "omega1_positive",
                    .rotary_key = "omega1_positive_rad_s",
                    .linear_key = "omega1_positive_m_s",
                    .doc = "speed constant of the falling static part, forward",
                    .lower = 0.0,
                    .upper = 1e3,
                    .scale = Scale::speed,
                    .starts = {3},
                    .optional = true},
                   {.id = "omega1_negative",
                    .rotary_key = "omega1_negative_rad_s",
                    .linear_key = "omega1_negative_m_s",
                    .doc = "the same backward, negative",
                    .lower = -1e3,
                    .upper = 0.0,
                    .scale = Scale::speed,
                    .starts = {-3},
                    .optional = true},
                   {.id = "omega1",
                    .rotary_key = "omega1_rad_s",
                    .linear_key = "omega1_m_s",
                    .doc = "the same for both directions",
                    .lower = 0.0,
                    .upper = 1e3,
                    .scale = Scale::speed,
                    .starts = {1.5, 5},
                    .optional = true,
                    .pair_of = "omega1_positive omega1_negative"},
                   {.id = "omega2_positive",
                    .rotary_key = "omega2_positive_rad_s",
                    .linear_key = "omega2_positive_m_s",
                    .doc = "speed constant of the rising Coulomb part, forward",
                    .lower = 0.0,
                    .upper = 1e3,
                    .scale = Scale::speed,
                    .starts = {3},
                    .optional = true},
                   {.id = "omega2_negative",
                    .rotary_key = "omega2_negative_rad_s",
                    .linear_key = "omega2_negative_m_s",
                    .doc = "the same backward, negative",
                    .lower = -1e3,
                    .upper = 0.0,
                    .scale = Scale::speed,
                    .starts = {-3},
                    .optional = true},
                   {.id = "omega2",
                    .rotary_key = "omega2_rad_s",
                    .linear_key = "omega2_m_s",
                    .doc = "the same for both directions",
                    .lower = 0.0,
                    .upper = 1e3,
                    .scale = Scale::speed,
                    .starts = {1.5, 5},
                    .optional = true,
                    .pair_of = "omega2_positive omega2_negative"}},
    .shows =
        "Residual torque rises towards zero speed, equally in acceleration and braking. Starts are late and jerky; "
        "slow motion shows stick-slip",
    .along = {"speed"},
    .confused_with = {"presliding", "friction_lag", "dwell_stiction", "nonlinear_viscous", "dac_dead_zone"},
    .separate_by =
        "Constant speeds, log-spaced from 0.05 to 10 rad/s, in both directions; a slow command ramp from rest for the "
        "static level",
    .origin =
        "Boundary lubrication of guideways and seals at low speed. Static over Coulomb friction: 1.0 to 1.2 on "
        "rolling, 1.3 to 2 on plain guides; it fades over 0.5 to 10 mm/s (textbook)",
    .remedy =
        "Way oil with friction modifier, shorter lubrication intervals; friction feed-forward at reversals; rolling or "
        "hydrostatic guides",
    .install = install_stribeck,
};

}  // namespace sim::effects
