// Cogging.
#include <algorithm>

#include "sim/drive.hpp"
#include "sim/effect.hpp"
#include "sim/harmonic.hpp"
#include "sim/periodic_effect.hpp"

namespace sim::effects {

namespace {

void install_cogging(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  const Harmonics harmonic(entry);
  drive.finest_period = std::min(drive.finest_period, harmonic.finest_period());
  drive.load_effort.push_back([harmonic](double, double x) { return harmonic(x); });
}

}  // namespace

extern const EffectInfo cogging;
const EffectInfo cogging{
    .kind = "cogging",
    .title = "Cogging",
    .equation = "T = T_motor + c cos(2 pi x/L) + s sin(2 pi x/L), and further orders of L; x: travel",
    .stage = Stage::load,
    .periodic = true,
    .parameters = {{.id = "cosine",
                    .rotary_key = "cosine_Nm",
                    .linear_key = "cosine_N",
                    .doc = "c",
                    .lower = -1e5,
                    .upper = 1e5,
                    .scale = Scale::coulomb,
                    .starts = {0.02}},
                   {.id = "sine",
                    .rotary_key = "sine_Nm",
                    .linear_key = "sine_N",
                    .doc = "s",
                    .lower = -1e5,
                    .upper = 1e5,
                    .scale = Scale::coulomb,
                    .starts = {0.02}},
                   period_parameter()},
    .shows =
        "Residual torque is periodic in position, with the same amplitude at any speed and current and the same sign "
        "in both directions",
    .along = {"position"},
    .confused_with = {"torque_ripple", "encoder_cyclic_error", "tach_ripple", "position_dependent_friction"},
    .separate_by =
        "Repeat a slow stroke with two loads: cogging is unchanged, ripple grows with the current. Sweep the speed: a "
        "sensor error grows with speed squared",
    .origin =
        "Magnets and slots of the motor (orders: slots, poles, their common multiples); ball passage in the screw "
        "(orders that are not integers)",
    .remedy = "Skewed or ironless motor; cogging table over the motor angle, realigned after each homing",
    .install = install_cogging,
};

}  // namespace sim::effects
