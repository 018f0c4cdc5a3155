// Cyclic error of the encoder.
#include "sim/drive.hpp"
#include "sim/effect.hpp"
#include "sim/harmonic.hpp"
#include "sim/periodic_effect.hpp"

namespace sim::effects {

namespace {

void install_encoder_cyclic_error(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  drive.encoder_error.push_back(Harmonics(entry));
}

}  // namespace

extern const EffectInfo encoder_cyclic_error;
const EffectInfo encoder_cyclic_error{
    .kind = "encoder_cyclic_error",
    .title = "Cyclic error of the encoder",
    .equation = "x_m = x + c cos(2 pi x/L) + s sin(2 pi x/L), and further orders of L; x: travel, x_m: reading",
    .stage = Stage::encoder,
    .periodic = true,
    .parameters = {position_error_parameter(true), position_error_parameter(false), period_parameter()},
    .shows =
        "Position error is periodic in position, with the same amplitude at any speed; the torque that it seems to "
        "need grows with the square of speed",
    .along = {"position"},
    .confused_with = {"cogging", "tach_ripple", "torque_ripple"},
    .separate_by =
        "Constant speeds: a fixed amplitude in position indicates the encoder, a fixed amplitude in torque cogging; a "
        "second scale or a laser decides",
    .origin =
        "Eccentric disc or coupling (once a turn), interpolation of the signals (once a grating period), lead error of "
        "the screw: 1 to 50 um (textbook)",
    .remedy = "Centre the disc; correct offset, gain and phase of the signals; error table over the travel",
    .install = install_encoder_cyclic_error,
};

}  // namespace sim::effects
