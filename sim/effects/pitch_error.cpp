// Pitch error of the screw.
#include "sim/drive.hpp"
#include "sim/effect.hpp"
#include "sim/harmonic.hpp"
#include "sim/periodic_effect.hpp"

namespace sim::effects {

namespace {

constexpr double kMicrometresInAMetre = 1e6;

void install_pitch_error(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  const double lead_error = entry.has("lead_error") ? entry.at("lead_error") / kMicrometresInAMetre : 0.0;
  drive.table_error.push_back(
      [lead_error, curve = Harmonics(entry)](double, double x) { return lead_error * x + curve(x); });
}

}  // namespace

extern const EffectInfo pitch_error;
const EffectInfo pitch_error{
    .kind = "pitch_error",
    .title = "Pitch error of the screw",
    .equation = "x_2 = x + d x + c cos(2 pi x/L) + s sin(2 pi x/L), and further orders of L; x_2: the table's travel",
    .stage = Stage::table,
    .periodic = true,
    .parameters = {{.id = "lead_error",
                    .rotary_key = "lead_error_um_per_m",
                    .linear_key = "lead_error_um_per_m",
                    .doc = "d: excess travel of the table",
                    .lower = -5000.0,
                    .upper = 5000.0,
                    .starts = {10.0},
                    .optional = true},
                   position_error_parameter(true),
                   position_error_parameter(false),
                   period_parameter()},
    .shows =
        "Only a scale on the table or a laser shows it: x2 - x is one curve over the travel, the same in both "
        "directions and at any force",
    .along = {"position"},
    .confused_with = {"encoder_cyclic_error", "thermal_growth"},
    .separate_by =
        "A slow run over the whole travel, both ways, with a scale on the table (x2_mm) or a dial gauge at steps. "
        "Repeat it after an hour: the part that has not changed is the screw's",
    .origin = "Screw as ground or rolled: 5 to 50 um in 300 mm (ISO 3408-3, P1 to P7); racks more",
    .remedy = "Pitch error compensation in the control; close the position loop by the scale",
    .install = install_pitch_error,
};

}  // namespace sim::effects
