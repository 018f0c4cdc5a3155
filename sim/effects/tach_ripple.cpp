// Ripple of the tachometer.
#include "sim/drive.hpp"
#include "sim/effect.hpp"
#include "sim/harmonic.hpp"
#include "sim/periodic_effect.hpp"

namespace sim::effects {

namespace {

void install_tach_ripple(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  drive.tach_ripple.push_back(Harmonics(entry));
}

}  // namespace

extern const EffectInfo tach_ripple;
const EffectInfo tach_ripple{
    .kind = "tach_ripple",
    .title = "Ripple of the tachometer",
    .equation =
        "w_m = w (1 + c cos(2 pi x/L) + s sin(2 pi x/L)), and further orders of L; w: true speed, w_m: reading, x: "
        "travel",
    .stage = Stage::tachometer,
    .periodic = true,
    .parameters = {{.id = "cosine",
                    .rotary_key = "cosine",
                    .linear_key = "cosine",
                    .doc = "c, relative",
                    .lower = -0.5,
                    .upper = 0.5,
                    .starts = {0.01}},
                   {.id = "sine",
                    .rotary_key = "sine",
                    .linear_key = "sine",
                    .doc = "s, relative",
                    .lower = -0.5,
                    .upper = 0.5,
                    .starts = {0.01}},
                   period_parameter()},
    .shows =
        "Error of the measured speed is periodic in position and proportional to speed; the encoder does not show it",
    .along = {"position"},
    .confused_with = {"cogging", "torque_ripple", "encoder_cyclic_error", "compliance"},
    .separate_by =
        "Constant speeds: compare the tachometer with the differentiated encoder over the motor angle; real motion "
        "shows in both",
    .origin = "Commutator bars, eccentric or skewed mounting of the tachometer: 1 to 3 % (textbook)",
    .remedy = "Align the tachometer; filter at the ripple's order; take the speed from the encoder",
    .install = install_tach_ripple,
};

}  // namespace sim::effects
