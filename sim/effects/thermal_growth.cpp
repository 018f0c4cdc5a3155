// Thermal growth between motor and table.
#include "sim/drive.hpp"
#include "sim/effect.hpp"
#include "sim/warming.hpp"

namespace sim::effects {

namespace {

void install_thermal_growth(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  const Warming warming(entry);
  drive.table_error.push_back(
      [warming, growth = entry.at("growth")](double t_s, double) { return growth * warming(t_s); });
}

}  // namespace

extern const EffectInfo thermal_growth;
const EffectInfo thermal_growth{
    .kind = "thermal_growth",
    .title = "Thermal growth between motor and table",
    .equation = "x_2 = x + g (1 - exp(-(t - t0)/tau)); x_2: the table's travel, t0: cold start",
    .stage = Stage::table,
    .parameters = {{.id = "growth",
                    .rotary_key = "growth_mm",
                    .linear_key = "growth_m",
                    .doc = "g: displacement of the table when warm",
                    .lower = -1.0,
                    .upper = 1.0,
                    .scale = Scale::millimetre,
                    .starts = {0.01}},
                   {.id = "time_constant",
                    .rotary_key = "time_constant_s",
                    .linear_key = "time_constant_s",
                    .doc = "time constant of warm-up, tau",
                    .lower = 0.5,
                    .upper = 1e5,
                    .scale = Scale::duration,
                    .starts = {1.0}},
                   cold_start_parameter(
                       "t0: time at which the growth is zero, on the clock of the records; default 0")},
    .shows = "Only a scale on the table shows it: x2 - x changes slowly with time, equally in both directions",
    .along = {"time", "temperature"},
    .confused_with = {"pitch_error", "backlash"},
    .separate_by =
        "Repeat one cycle for an hour with a scale on the table, stop, repeat; log the temperature of nut and bearing",
    .origin =
        "Friction warms screw and nut: the steel between fixed bearing and nut grows by 11 um per metre and kelvin",
    .remedy = "Close the position loop by the scale; warm-up cycle; cooled or pretensioned screw",
    .install = install_thermal_growth,
};

}  // namespace sim::effects
