// Ripple of the tachometer.
#include "sim/drive.hpp"
#include "sim/effect.hpp"
#include "sim/harmonic.hpp"

namespace sim::effects {

namespace {

void install([[maybe_unused]] const EffectEntry& entry, [[maybe_unused]] const DataSheet& data, Drive& drive) {
  drive.tach_ripple.push_back(Harmonic{entry.at("cosine"), entry.at("sine"), entry.at("period")});
}

}  // namespace

extern const EffectInfo tach_ripple;
const EffectInfo tach_ripple{
    .kind = "tach_ripple",
    .title = "Ripple of the tachometer",
    .equation = "w_m = w (1 + c cos(2 pi x/L) + s sin(2 pi x/L))",
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
                   {.id = "period",
                    .rotary_key = "period_mm",
                    .linear_key = "period_m",
                    .doc = "L: travel of one period",
                    .lower = 1e-5,
                    .upper = 1e5,
                    .scale = Scale::millimetre}},
    .shows =
        "error of the measured speed periodic in position and proportional to the speed; the encoder does not show it",
    .confused_with = {"cogging", "torque_ripple", "encoder_cyclic_error"},
    .separate_by = "constant speeds: compare the tachometer with the differentiated encoder over the motor angle",
    .origin = "commutator bars, eccentric rotor of the tachometer",
    .remedy = "align the tachometer; filter at the ripple order",
    .install = install,
};

}  // namespace sim::effects
