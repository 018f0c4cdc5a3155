// Offset of the command.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install_dac_offset(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  const double offset = entry.at("offset");
  drive.command.push_back([offset](double u_V) { return u_V + offset; });
}

}  // namespace

extern const EffectInfo dac_offset;
const EffectInfo dac_offset{
    .kind = "dac_offset",
    .title = "Offset of the command",
    .equation = "u_eff = u + u_0; u: command",
    .stage = Stage::command,
    .parameters = {{.id = "offset",
                    .rotary_key = "offset_V",
                    .linear_key = "offset_V",
                    .doc = "u_0: output at zero command",
                    .lower = -500.0,
                    .upper = 500.0,
                    .scale = Scale::converter_range,
                    .starts = {0.002, -0.002}}},
    .shows =
        "Residual torque is constant, with the same sign in both directions and at rest; its source is the "
        "electronics, not the mechanics",
    .along = {"speed", "current"},
    .confused_with = {"constant_torque", "coulomb_asymmetry", "viscous_asymmetry"},
    .separate_by =
        "Measure the converter's output at zero command with a voltmeter. Motion alone cannot tell it from a constant "
        "torque",
    .origin = "Drift of the converter or of the amplifier's input: 0.1 to 2 % of full scale (textbook)",
    .remedy = "Trim the offset; check earth and shielding of the command line",
    .install = install_dac_offset,
};

}  // namespace sim::effects
