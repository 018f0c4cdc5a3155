#include "host/plan/simulated_run.hpp"

#include "hal/pc/simulated_axis.hpp"
#include "host/identify/axis_design.hpp"
#include "host/parameters/axis_parameters.hpp"
#include "host/parameters/board_parameters.hpp"
#include "host/parameters/parameter_names.hpp"

namespace host {

firmware::ParameterValues design_values(const sim::DriveDescription& model) {
  firmware::ParameterValues values;
  const auto set = [&](const std::string& name, double value) {
    values.set(require_place("x." + name), static_cast<float>(value));
  };
  for (const BoardParameter& parameter :
       board_parameters(model, design_axis(model, {}), ReferenceLimits::usual_for(model.data.kind)))
    set(parameter.name, parameter.value);
  set("tachometer.gain", hal::pc::AxisWiring{}.tachometer_resolution);
  return values;
}

ExcitationScale scale_of_drive(const sim::DataSheet& data) {
  const ReferenceLimits limits = ReferenceLimits::usual_for(data.kind);
  ExcitationScale scale;
  scale.kind = data.kind;
  scale.encoder_resolution = data.encoder_resolution;
  scale.dac_resolution_V = data.dac_resolution_V;
  scale.lead = data.lead;
  scale.rate_Hz = 1.0 / data.sample_period_s;
  scale.has_tachometer = data.tach_noise_variance.has_value();
  scale.acceleration = limits.acceleration;
  scale.jerk = limits.jerk;
  return scale;
}

RunOutcome simulate_run(const RunPlan& run, const sim::DriveDescription& machine,
                        const firmware::ParameterValues& board, std::uint64_t seed) {
  sim::Plant plant(machine, seed);
  hal::pc::SimulatedAxis wires(plant);
  ExcitedAxis axis(wires, board, machine, [&] { plant.advance(machine.data.sample_period_s); });
  RunOutcome outcome = run_on(axis, run, scale_of_drive(machine.data));
  outcome.record.path = "simulated run";
  return outcome;
}

}  // namespace host
