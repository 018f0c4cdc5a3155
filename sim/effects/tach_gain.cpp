// Gain of the tachometer.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install([[maybe_unused]] const EffectEntry& entry, [[maybe_unused]] const DataSheet& data, Drive& drive) {
  drive.tach_gain *= entry.at("gain");
}

}  // namespace

extern const EffectInfo tach_gain;
const EffectInfo tach_gain{
    .kind = "tach_gain",
    .title = "Gain of the tachometer",
    .equation = "w_m = g w",
    .stage = Stage::tachometer,

    .parameters = {{.id = "gain",
                    .rotary_key = "gain",
                    .linear_key = "gain",
                    .doc = "g",
                    .lower = 0.5,
                    .upper = 2.0,
                    .starts = {0.98, 1.02}}},
    .shows = "the integral of the measured speed leaves the encoder in proportion to the travel",
    .confused_with = {"viscous", "inertia"},
    .separate_by = "integrate the tachometer over a long stroke and compare with the encoder",
    .origin = "ageing magnets, a potentiometer out of trim, the wrong scale",
    .remedy = "calibrate against the encoder",
    .install = install,
};

}  // namespace sim::effects
