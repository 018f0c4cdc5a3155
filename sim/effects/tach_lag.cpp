// Lag of the tachometer.
#include <numbers>

#include "sim/drive.hpp"
#include "sim/effect.hpp"

namespace sim::effects {

namespace {

void install_tach_lag(const EffectEntry& entry, const DataSheet&, Drive& drive) {
  drive.tach_lag_s = 1.0 / (2.0 * std::numbers::pi * entry.at("bandwidth"));
}

}  // namespace

extern const EffectInfo tach_lag;
const EffectInfo tach_lag{
    .kind = "tach_lag",
    .title = "Lag of the tachometer",
    .equation = "dw_m/dt = 2 pi f (w - w_m); w: true speed, w_m: reading",
    .stage = Stage::tachometer,
    .parameters = {{.id = "bandwidth",
                    .rotary_key = "bandwidth_Hz",
                    .linear_key = "bandwidth_Hz",
                    .doc = "f",
                    .lower = 2.0,
                    .upper = 2000.0,
                    .starts = {50, 150}}},
    .shows =
        "The measured speed lags the derivative of the position, in proportion to acceleration; the position has no "
        "lag",
    .along = {"acceleration"},
    .confused_with = {"current_loop_lag", "input_delay", "friction_lag"},
    .separate_by =
        "Compare the tachometer with the differentiated encoder during a hard acceleration: a lag of the sensor does "
        "not affect the encoder, a lag of the drive delays both",
    .origin = "Ripple filter behind the tachometer, slow A/D conversion",
    .remedy = "A faster filter, or model it in the observer",
    .install = install_tach_lag,
};

}  // namespace sim::effects
