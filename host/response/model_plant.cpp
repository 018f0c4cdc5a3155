#include <numbers>

#include "host/identify/linear_axis.hpp"
#include "host/response/plant_fit.hpp"

namespace host {

PlantFit plant_of(const sim::DriveDescription& model) {
  const RigidAxis axis = rigid_axis(model);
  PlantFit fit;
  fit.sample_period_s = model.data.sample_period_s;
  fit.position_gain = axis.gain() * axis.lead;
  fit.speed_gain = axis.gain();
  fit.pole = -axis.pole();
  if (const sim::EffectEntry* const delay = model.find("input_delay")) fit.delay_s.value = delay->at("delay");
  if (const sim::EffectEntry* const lag = model.find("current_loop_lag"))
    fit.lag_s.value = 1.0 / (2.0 * std::numbers::pi * lag->at("bandwidth"));
  if (const sim::EffectEntry* const spring = model.find("compliance")) {
    const double load = spring->at("load_fraction"), share = load / (1.0 - load);
    fit.resonances.push_back({{spring->at("resonance"), {}}, {spring->at("damping_ratio"), {}}, share, share});
  }
  return fit;
}

}  // namespace host
