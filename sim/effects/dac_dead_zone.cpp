// Dead zone of the command.
#include <cmath>

#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install([[maybe_unused]] const EffectEntry& entry, [[maybe_unused]] const DataSheet& data, Drive& drive) {
  const double width = entry.at("width");
  drive.command.push_back(
      [width](double u_V) { return std::abs(u_V) <= width ? 0.0 : u_V - std::copysign(width, u_V); });
}

}  // namespace

extern const EffectInfo dac_dead_zone;
const EffectInfo dac_dead_zone{
    .kind = "dac_dead_zone",
    .title = "Dead zone of the command",
    .equation = "u_eff = 0 for |u| <= d, else u - d sign(u)",
    .stage = Stage::command,

    .parameters = {{.id = "width",
                    .rotary_key = "width_V",
                    .linear_key = "width_V",
                    .doc = "d",
                    .lower = 0.0,
                    .upper = 5.0,
                    .starts = {0.05}}},
    .shows = "residual changes sign with the command, not with the motion",
    .confused_with = {"load_dependent_friction", "stribeck", "coulomb"},
    .separate_by = "coupling off: a slow ramp of the command through zero, both ways",
    .origin = "output stage of converter or amplifier, deliberate dead band",
    .remedy = "switch the dead band off; replace the output stage",
    .install = install,
};

}  // namespace sim::effects
