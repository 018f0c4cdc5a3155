#include "host/response/model_starts.hpp"

#include <fmt/format.h>

#include <numbers>

#include "sim/catalogue.hpp"

namespace host {

namespace {

/// Smallest significant delay in sampling periods: the uncertainty of fits and clocks.
constexpr double kLeastDelay = 0.05;

bool is_possible(const sim::EffectInfo& info, const char* id, double value) {
  const sim::ParameterInfo* parameter = info.parameter(id);
  return parameter != nullptr && value > parameter->lower && value < parameter->upper;
}

sim::EffectEntry& entry_of(sim::DriveDescription& model, const char* kind) {
  if (sim::EffectEntry* const found = model.find(kind)) return *found;
  sim::EffectEntry made;
  made.kind = kind;
  model.effects.push_back(made);
  return model.effects.back();
}

void put(sim::EffectEntry& entry, const char* id, const Interval95& value) {
  if (entry.held.contains(id)) return;
  entry.parameters[id] = value.value;
  entry.ci95[id] = value.ci95;
}

void put_compliance(const PlantFit& fit, const std::string& from, ModelStarts& starts) {
  if (fit.resonances.empty()) return;
  const Resonance& mode = fit.resonances.front();
  const sim::EffectInfo& info = *sim::find_effect("compliance");
  // Measured at the motor, the mode's share is load inertia over motor inertia. At the table it is always -1.
  const double seen = mode.speed_share > 0.0 ? mode.speed_share : mode.position_share;
  const double load = seen / (1.0 + seen);
  const std::string text = fmt::format("resonance at {:.4g} Hz", mode.f_Hz.value);
  if (!(seen > 0.0) || !is_possible(info, "load_fraction", load) || !is_possible(info, "resonance", mode.f_Hz.value) ||
      !is_possible(info, "damping_ratio", mode.damping.value)) {
    starts.said.push_back(text + ": does not match two masses measured at the motor; left out");
    return;
  }
  sim::EffectEntry& entry = entry_of(starts.model, "compliance");
  put(entry, "resonance", mode.f_Hz);
  put(entry, "damping_ratio", mode.damping);
  if (!entry.held.contains("load_fraction")) entry.parameters["load_fraction"] = load;
  entry.from = from;
  starts.said.push_back(fmt::format("{}: compliance, load fraction {:.3g}", text, load));
}

void put_delay(const PlantFit& fit, const std::string& from, ModelStarts& starts) {
  const Interval95& delay = fit.delay_s;
  if (!(delay.ci95[0] > 0.0) || delay.value < kLeastDelay * fit.sample_period_s) return;
  if (!is_possible(*sim::find_effect("input_delay"), "delay", delay.value)) return;
  sim::EffectEntry& entry = entry_of(starts.model, "input_delay");
  put(entry, "delay", delay);
  entry.from = from;
  starts.said.push_back(
      fmt::format("delay of {:.3g} ms: input_delay (a current loop of {:.0f} Hz gives the same phase)",
                  1e3 * delay.value, 0.5 / (std::numbers::pi * delay.value)));
}

void put_lag(const PlantFit& fit, const std::string& from, ModelStarts& starts) {
  const Interval95& lag = fit.lag_s;
  if (!(lag.ci95[0] > 0.0) || lag.value < kLeastDelay * fit.sample_period_s) return;
  const auto bandwidth = [](double lag_s) { return 0.5 / (std::numbers::pi * lag_s); };
  const Interval95 f_Hz{bandwidth(lag.value), {bandwidth(lag.ci95[1]), bandwidth(lag.ci95[0])}};
  if (!is_possible(*sim::find_effect("current_loop_lag"), "bandwidth", f_Hz.value)) return;
  sim::EffectEntry& entry = entry_of(starts.model, "current_loop_lag");
  put(entry, "bandwidth", f_Hz);
  entry.from = from;
  starts.said.push_back(fmt::format("magnitude and phase fall like a lag of {:.3g} ms: current_loop_lag, {:.3g} Hz",
                                    1e3 * lag.value, f_Hz.value));
}

}  // namespace

ModelStarts with_response(const sim::DriveDescription& model, const PlantFit& fit, const std::string& from) {
  ModelStarts starts{model, {}};
  put_compliance(fit, from, starts);
  put_delay(fit, from, starts);
  put_lag(fit, from, starts);
  if (starts.said.empty()) starts.said.emplace_back("no significant resonance, delay or lag: the model is unchanged");
  return starts;
}

}  // namespace host
