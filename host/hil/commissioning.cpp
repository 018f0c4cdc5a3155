#include "host/hil/commissioning.hpp"

#include "hal/pc/simulated_axis.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/hil/simulated_experiment.hpp"
#include "host/identify/friction_identification.hpp"
#include "host/identify/identification.hpp"
#include "host/parameters/compensation_parameters.hpp"

namespace host {

Record commissioning_steps(const sim::DriveDescription& machine, double scaling, std::uint64_t seed) {
  return record_open_loop(machine, doublet_series(scaling * kStepUnit_V, machine.data.sample_period_s), seed);
}

sim::DriveDescription commission(const sim::DriveDescription& machine, std::uint64_t seed) {
  constexpr double kStepScaling = 15.0;  // Ku, p. 1499
  constexpr double kPitch_mm = 10.0;     // Table 1
  const Record steps = commissioning_steps(machine, kStepScaling, seed);
  const Identification rigid = identify_drive(MeasurementGate(data_sheet_of(machine)).admit({steps}),
                                              data_sheet_of(machine), IdentificationMethod::sliding_ls);
  const AxisDesign design = design_axis(rigid.model, {});
  const auto programme = jogging_programme({kPaperJogSpeeds_mm_s.begin(), kPaperJogSpeeds_mm_s.end()}, kPitch_mm);
  const Record jogs = record_jogs(machine, design, programme, seed + 1);
  return identify_friction(MeasurementGate(rigid.model).admit({jogs}), rigid.model, FrictionMethod::joint).model;
}

firmware::AxisParameters<float> contouring_parameters(const sim::DriveDescription& model,
                                                      const CompensationSwitches& switches,
                                                      const ReferenceLimits& limits, const LoopTuning& tuning) {
  DesignOptions options;
  options.bandwidth_Hz = tuning.bandwidth_Hz;
  auto parameters =
      axis_parameters(model, design_axis(model, options), hal::pc::AxisWiring{}.tachometer_resolution, limits);
  parameters.filters = core_filters(tuning.filters, model.data.sample_period_s);
  parameters.zero_phase_feedforward_on = true;
  parameters.friction_feedforward_on = switches.friction;
  parameters.disturbance_cancellation_on = switches.cancellation;
  if (!switches.effects) return parameters;
  parameters.compensation = core_compensation(model);
  const TachometerReading tachometer = tachometer_reading(model);
  parameters.tachometer_gain /= static_cast<float>(tachometer.gain);
  parameters.tachometer_offset = static_cast<float>(tachometer.offset / tachometer.gain);
  return parameters;
}

}  // namespace host
