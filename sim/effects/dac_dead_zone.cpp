// Dead zone of the command.
#include <cmath>

#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install_dac_dead_zone(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  const double width = entry.at("width");
  drive.command.push_back(
      [width](double u_V) { return std::abs(u_V) <= width ? 0.0 : u_V - std::copysign(width, u_V); });
}

}  // namespace

extern const EffectInfo dac_dead_zone;
const EffectInfo dac_dead_zone{
    .kind = "dac_dead_zone",
    .title = "Dead zone of the command",
    .equation = "u_eff = 0 for |u| <= d, else u - d sign(u); u: command",
    .stage = Stage::command,
    .parameters = {{.id = "width",
                    .rotary_key = "width_V",
                    .linear_key = "width_V",
                    .doc = "d",
                    .lower = 0.0,
                    .upper = 500.0,
                    .scale = Scale::converter_range,
                    .starts = {0.005}}},
    .shows = "Residual changes sign with the command, not with the motion; commands within the zone have no effect",
    .along = {"current"},
    .confused_with = {"load_dependent_friction", "stribeck", "coulomb", "dac_offset"},
    .separate_by =
        "With the coupling off, ramp the command slowly through zero in both directions. A dead zone follows the sign "
        "of the command, friction that of the speed",
    .origin =
        "Output stage of converter or amplifier, deliberate dead band of the drive: 0.1 to 2 % of full scale "
        "(textbook)",
    .remedy = "Switch the dead band off; replace the output stage; add the width to the command",
    .install = install_dac_dead_zone,
};

}  // namespace sim::effects
