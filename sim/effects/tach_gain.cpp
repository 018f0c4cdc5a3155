// Gain of the tachometer.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install_tach_gain(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  drive.tach_gain *= entry.at("gain");
}

}  // namespace

extern const EffectInfo tach_gain;
const EffectInfo tach_gain{
    .kind = "tach_gain",
    .title = "Gain of the tachometer",
    .equation = "w_m = g w; w: true speed, w_m: reading",
    .stage = Stage::tachometer,
    .parameters = {{.id = "gain",
                    .rotary_key = "gain",
                    .linear_key = "gain",
                    .doc = "g",
                    .lower = 0.5,
                    .upper = 2.0,
                    .starts = {0.98, 1.02}}},
    .shows =
        "The integral of the measured speed departs from the encoder in proportion to travel; the torque shows "
        "nothing, because inertia and viscous friction absorb the error",
    .along = {"speed"},
    .confused_with = {"viscous", "inertia"},
    .separate_by =
        "Integrate the tachometer over a long stroke and compare with the encoder, in both directions, so that an "
        "offset cancels",
    .origin = "Ageing magnets, a misadjusted potentiometer, a wrong scale: 0.5 to 2 % (textbook)",
    .remedy = "Calibrate against the encoder",
    .install = install_tach_gain,
};

}  // namespace sim::effects
