// Offset of the tachometer.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install_tach_offset(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  drive.tach_offset += entry.at("offset");
}

}  // namespace

extern const EffectInfo tach_offset;
const EffectInfo tach_offset{
    .kind = "tach_offset",
    .title = "Offset of the tachometer",
    .equation = "w_m = w + b; w: true speed, w_m: reading",
    .stage = Stage::tachometer,
    .parameters = {{.id = "offset",
                    .rotary_key = "offset_rad_s",
                    .linear_key = "offset_m_s",
                    .doc = "b",
                    .lower = -100.0,
                    .upper = 100.0,
                    .scale = Scale::speed,
                    .starts = {0.1, -0.1}}},
    .shows = "The tachometer reads a speed at standstill; its integral departs from the encoder in proportion to time",
    .along = {"time", "speed"},
    .confused_with = {"viscous_asymmetry", "constant_torque", "dac_offset"},
    .separate_by = "Read the tachometer at standstill, before and after a run",
    .origin = "Offset of the A/D converter or of the amplifier in front of it",
    .remedy = "Trim, or subtract the reading at standstill",
    .install = install_tach_offset,
};

}  // namespace sim::effects
