// Offset of the command.
#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install([[maybe_unused]] const EffectEntry& entry, [[maybe_unused]] const DataSheet& data, Drive& drive) {
  const double offset = entry.at("offset");
  drive.command.push_back([offset](double u_V) { return u_V + offset; });
}

}  // namespace

extern const EffectInfo dac_offset;
const EffectInfo dac_offset{
    .kind = "dac_offset",
    .title = "Offset of the command",
    .equation = "u_eff = u + u_0",
    .stage = Stage::command,

    .parameters = {{.id = "offset",
                    .rotary_key = "offset_V",
                    .linear_key = "offset_V",
                    .doc = "u_0: output at zero command",
                    .lower = -5.0,
                    .upper = 5.0,
                    .starts = {0.02, -0.02}}},
    .shows = "residual torque constant, of one sign in both directions",
    .confused_with = {"constant_torque", "coulomb_asymmetry"},
    .separate_by = "voltmeter at the converter with zero command",
    .origin = "drift of converter or amplifier input",
    .remedy = "trim the offset",
    .install = install,
};

}  // namespace sim::effects
