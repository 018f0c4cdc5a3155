// Cyclic error of the encoder.
#include "sim/drive.hpp"
#include "sim/effect.hpp"
#include "sim/harmonic.hpp"

namespace sim::effects {

namespace {

void install([[maybe_unused]] const EffectEntry& entry, [[maybe_unused]] const DataSheet& data, Drive& drive) {
  drive.encoder_error.push_back(Harmonic{entry.at("cosine"), entry.at("sine"), entry.at("period")});
}

}  // namespace

extern const EffectInfo encoder_cyclic_error;
const EffectInfo encoder_cyclic_error{
    .kind = "encoder_cyclic_error",
    .title = "Cyclic error of the encoder",
    .equation = "x_m = x + c cos(2 pi x/L) + s sin(2 pi x/L)",
    .stage = Stage::encoder,
    .periodic = true,
    .parameters = {{.id = "cosine",
                    .rotary_key = "cosine_mm",
                    .linear_key = "cosine_m",
                    .doc = "c",
                    .lower = -1.0,
                    .upper = 1.0,
                    .scale = Scale::millimetre,
                    .starts = {0.002}},
                   {.id = "sine",
                    .rotary_key = "sine_mm",
                    .linear_key = "sine_m",
                    .doc = "s",
                    .lower = -1.0,
                    .upper = 1.0,
                    .scale = Scale::millimetre,
                    .starts = {0.002}},
                   {.id = "period",
                    .rotary_key = "period_mm",
                    .linear_key = "period_m",
                    .doc = "L: travel of one period",
                    .lower = 1e-5,
                    .upper = 1e5,
                    .scale = Scale::millimetre}},
    .shows = "error of the position periodic in position; in torque it grows with the square of the speed",
    .confused_with = {"cogging", "tach_ripple"},
    .separate_by = "constant speeds: a fixed size in position points to the encoder; a second scale or a laser decides",
    .origin = "eccentric disc or coupling, interpolation error",
    .remedy = "centre the disc; correct offset, gain and phase of the signals",
    .install = install,
};

}  // namespace sim::effects
