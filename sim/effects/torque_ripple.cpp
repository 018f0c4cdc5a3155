// Torque ripple.
#include <algorithm>

#include "sim/drive.hpp"
#include "sim/effect.hpp"
#include "sim/harmonic.hpp"
#include "sim/periodic_effect.hpp"

namespace sim::effects {

namespace {

void install_torque_ripple(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  const Harmonics harmonic(entry);
  drive.finest_period = std::min(drive.finest_period, harmonic.finest_period());
  drive.effort_factor.push_back([harmonic](double x) { return 1.0 + harmonic(x); });
}

}  // namespace

extern const EffectInfo torque_ripple;
const EffectInfo torque_ripple{
    .kind = "torque_ripple",
    .title = "Torque ripple",
    .equation =
        "T = K_t i (1 + c cos(2 pi x/L) + s sin(2 pi x/L)), and further orders of L; i: motor current, x: travel",
    .stage = Stage::motor,
    .periodic = true,
    .parameters = {{.id = "cosine",
                    .rotary_key = "cosine",
                    .linear_key = "cosine",
                    .doc = "c, relative",
                    .lower = -0.9,
                    .upper = 0.9,
                    .starts = {0.02}},
                   {.id = "sine",
                    .rotary_key = "sine",
                    .linear_key = "sine",
                    .doc = "s, relative",
                    .lower = -0.9,
                    .upper = 0.9,
                    .starts = {0.02}},
                   period_parameter()},
    .shows =
        "Residual torque is periodic in position and proportional to the current: strong during acceleration, weak "
        "while coasting",
    .along = {"position"},
    .confused_with = {"cogging", "tach_ripple", "encoder_cyclic_error", "load_dependent_friction"},
    .separate_by =
        "Repeat a stroke with two loads, or compare constant speed with hard acceleration over the same travel: "
        "cogging is unchanged, ripple grows with the current",
    .origin =
        "Commutation, non-sinusoidal back-EMF (sixth order of the pole pair), unbalanced current sensors (first and "
        "second order)",
    .remedy = "Calibrate the current sensors' offsets and gains; ripple table over the motor angle",
    .install = install_torque_ripple,
};

}  // namespace sim::effects
