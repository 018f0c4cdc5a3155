// Offset of the tachometer.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install([[maybe_unused]] const EffectEntry& entry, [[maybe_unused]] const DataSheet& data, Drive& drive) {
  drive.tach_offset += entry.at("offset");
}

}  // namespace

extern const EffectInfo tach_offset;
const EffectInfo tach_offset{
    .kind = "tach_offset",
    .title = "Offset of the tachometer",
    .equation = "w_m = w + b",
    .stage = Stage::tachometer,

    .parameters = {{.id = "offset",
                    .rotary_key = "offset_rad_s",
                    .linear_key = "offset_m_s",
                    .doc = "b",
                    .lower = -100.0,
                    .upper = 100.0,
                    .scale = Scale::speed,
                    .starts = {0.1, -0.1}}},
    .shows = "the tachometer reads a speed while the axis stands",
    .confused_with = {"viscous_asymmetry", "constant_torque"},
    .separate_by = "read the tachometer at standstill",
    .origin = "offset of the converter or of its amplifier",
    .remedy = "trim, or subtract the reading at standstill",
    .install = install,
};

}  // namespace sim::effects
